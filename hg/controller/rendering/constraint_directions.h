/// Effect of a unit constraint force of a device limit on the handle and the twin.
///
/// Source: [HG] (21)-(24), which are one formula: a row C ddq_m pushes the handle with the wrench
/// y, J_m^T y = C^T, and the twin with J_a^T y. For a Cartesian limit of the handle y is a unit
/// force, for q4 + q5 a unit torque about their common axis. J_m^-T is never formed. No allocation,
/// noexcept after construction.
#pragma once

#include <Eigen/QR>

#include "hg/controller/rendering/twin_model.h"
#include "hg/hqp/problem.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"
#include "hg/signals/limit.h"

namespace hg::rendering {

static_assert(kMaxManipulator == 7, "at most one joint to spare");

class ConstraintDirections {
 public:
  ConstraintDirections(const DeviceModel& device, const TwinModel& twin);

  /// Sets the Jacobians of this cycle: handle (gantry first) and end effector of the twin. Call
  /// before find(), whose first call factors J_m.
  void update(const model::Jacobian& J_H, const model::Jacobian& J_a) noexcept;

  /// Computes the columns of device limit `limit`, whose row of `problem` is `row`.
  void find(const hqp::Problem& problem, int row, int limit) noexcept;

  /// Wrench y on the handle, in B.
  Vector6 wrench(int limit) const noexcept { return wrench_.col(limit); }
  /// Torques J_a^T y on the twin (n_a).
  auto torque(int limit) const noexcept { return torque_.col(limit); }
  /// Product C N, with N the motion of seven joints that leaves the handle at rest; 0 with six
  /// joints.
  double idle(int limit) const noexcept { return idle_[limit]; }

 private:
  using Factor = Eigen::ColPivHouseholderQR<
      Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMaxManipulator, 6>>;

  int n_p_, n_m_;
  model::Jacobian J_m_;
  bool is_factored_ = false;
  Factor J_m_T_;
  model::Jacobian J_a_;
  MatrixUpTo<6, kMaxLimits> wrench_;
  MatrixUpTo<kMaxTwin, kMaxLimits> torque_;
  VectorUpTo<kMaxLimits> idle_;
};

}  // namespace hg::rendering

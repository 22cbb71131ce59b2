/// The wrench at the handle as arms without a force/torque sensor estimate it: from the torques of
/// their joints, less what their model says that motion and weight need.
///
/// It differs from the true wrench by what the model does not know,
///   J^T dw = e,  e = friction tau_max tanh(q' / v_0) + offset + weight c
/// solved with damping, since near a singularity the joints do not feel a direction. SI units.
/// No allocation, noexcept after set-up.
#pragma once

#include <cstdint>

#include "hg/core/types.h"

namespace hg::simulator {

using JacobianM = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxManipulator>;

/// Set-up data; shares are of the peak torque of each joint. 0 disables an effect.
struct TorqueEstimateConfig {
  bool is_used = false;   ///< false: a force/torque sensor measures the wrench
  double friction = 0.0;  ///< friction that the arm does not compensate, share, >= 0
  double offset = 0.0;    ///< standard deviation of the offset of a torque sensor, share, >= 0
  double weight = 0.0;    ///< share of the torque that carries the arm that its model lacks, >= 0
};

class TorqueEstimate {
 public:
  TorqueEstimate() = default;
  /// `torque_max`: peak torque of each joint, Nm.
  TorqueEstimate(const TorqueEstimateConfig& config, const VectorM& torque_max, std::uint64_t seed);

  /// Estimated minus true wrench at the handle, in B, force first. `J`: of the handle, `dq`: speeds
  /// of the joints, rad/s, `carrying`: torques that carry the arm, Nm.
  Vector6 error(const JacobianM& J, const VectorM& dq, const VectorM& carrying) const noexcept;

 private:
  TorqueEstimateConfig config_;
  VectorM torque_max_, offset_;  // Nm
};

}  // namespace hg::simulator

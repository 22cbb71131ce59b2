/// The tasks of the rendering law as one lexicographic problem, refilled every cycle.
///
/// Source: [HG] (9)-(19) and Table II, tasks 1-6; the last level is Gauss' principle of least
/// constraint instead of (20)-(26), see docs/architecture.md. Decision variable x = (ddq_m, ddq_a).
///
///   level 0         coupling of H and E (12), 6 equalities
///   level 1         manipulator joints
///   level 2         virtual joints (singularity)
///   level 3, 4, ... Cartesian limits, a level per frame
///   then            twin joints and locks
///   last            L^T ddq_a = L^-1 tau with M_a = L L^T
///
/// No allocation after construction.
#pragma once

#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/rendering/device_model.h"
#include "hg/rendering/options.h"
#include "hg/rendering/twin_forces.h"
#include "hg/rendering/twin_model.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// One row of levels 1.. to the last but one, in catalogue order: limit i is row first_limit_row()
/// + i.
struct LimitRow {
  Interval range;              ///< configured positions
  limits::JointLimits limits;  ///< as rendered: with margins, and this cycle's locks
  limits::RecoverableOptions options;
  double rating = 1.0;       ///< weight of the row is 1 / rating
  Holds held_by;             ///< locks, latches and friction, this cycle
  double q = 0.0, dq = 0.0;  ///< this cycle
};

/// What the law knows of one cycle besides the chains, which must have been updated.
struct TaskInput {
  const RobotState& robot;
  const ReferenceState& reference;
  const TwinState& twin;
  const TwinInnerState& inner;
  VectorA tau;  ///< all torques on the twin that are not constraints, without c_a
};

class Tasks {
 public:
  Tasks(const DeviceModel& device, const TwinModel& twin, const Options& options);

  /// Writes all rows. `device` and `twin` are the models given to the constructor, with updated
  /// chains.
  void fill(const DeviceModel& device, const TwinModel& twin, const TaskInput& input) noexcept;

  const hqp::Problem& problem() const noexcept { return problem_; }
  const std::vector<LimitRow>& limit_rows() const noexcept { return limit_rows_; }
  int first_limit_row() const noexcept { return 6; }
  /// Level 0's right-hand side (11): how H has to accelerate relative to E.
  const Vector6& synchronisation() const noexcept { return s_; }
  /// M_a = L L^T of this cycle.
  const MatrixUpTo<kMaxTwin, kMaxTwin>& L() const noexcept { return L_; }

 private:
  void fill_coupling(const DeviceModel& device, const TwinModel& twin,
                     const TaskInput& input) noexcept;
  void fill_device_limits(const DeviceModel& device, const TaskInput& input) noexcept;
  void fill_twin_limits(const TwinModel& twin, const TaskInput& input) noexcept;
  void fill_dynamics(const TwinModel& twin, const TaskInput& input) noexcept;
  void set_limit(int limit, const limits::JointLimits& limits, double q, double dq,
                 double known_acceleration) noexcept;

  Options options_;
  int n_m_, n_a_;
  hqp::Problem problem_;
  std::vector<LimitRow> limit_rows_;
  std::vector<double> coefficients_;  ///< scratch, one row
  Vector6 s_ = Vector6::Zero();
  MatrixUpTo<kMaxTwin, kMaxTwin> L_;
};

}  // namespace hg::rendering

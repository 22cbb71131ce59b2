/// Whether the device can brake before all its limits together, and how much more than that.
///
/// Ours; docs/law.md, "Braking together". Limit k at speed v towards an end that is d away needs a
/// deceleration of n_k = v^2 / (2 d) to stop in front of it. The reserve is the largest mu for
/// which there is one motion of device and twin with
///   - the handle on the twin, and the gantry within what its drives can follow,
///   - every motor within what it may be asked for,
///   - and C_k ddq <= room_k - mu n_k for every limit k, mirrored for lower ends,
/// where room_k >= 0 is what limit k may still accelerate because its end is far. With mu >= 1 the
/// device stops before all of them; each n_k then stays as it is or shrinks.
/// No allocation after construction.
#pragma once

#include <span>
#include <vector>

#include "hg/core/interval.h"
#include "hg/hqp/solver.h"
#include "hg/limits/acceleration_bounds.h"

namespace hg::rendering {

inline constexpr double kMostReserve = 100.0;  ///< more than that nobody asks for

/// A coordinate on its way to an end of its limits.
struct Approach {
  double need = 0.0;  ///< rad/s^2 or m/s^2: > 0 towards the upper end, < 0 towards the lower one
  Interval room;      ///< of accelerations while nothing has to brake; holds 0
};

/// How `q` with speed `dq` approaches the ends of `limits`. A coordinate whose need is below a part
/// of ddq_max has room as bounds R with that part of it would leave.
Approach approach(const limits::JointLimits& limits, const limits::RecoverableOptions& options,
                  double q, double dq, double dt) noexcept;

/// Whether the need is worth a look at the reserve.
bool is_near(const Approach& approach, const limits::JointLimits& limits) noexcept;

/// Bounds of acceleration with which all limits that need it brake together, once `reserve` is no
/// more than what changes of posture may take of it: `bounds` made narrower, never empty.
Interval braking_bounds(const Approach& approach, double reserve, Interval bounds,
                        const limits::JointLimits& limits,
                        const limits::RecoverableOptions& options, double dq) noexcept;

class JointBraking {
 public:
  /// Of `tasks`: rows 0 .. fixed - 1 always hold; then follow the limits, of which `motors` are
  /// rows of motors and not approached.
  JointBraking(const hqp::Problem& tasks, int fixed, int limits, int first_motor, int motors);

  /// The reserve. `tasks` has this cycle's rows; `torque` are the bounds of the motors' rows,
  /// `approaches` those of all limits (motors: not read) and `known` the accelerations that they
  /// have without x. At most kMostReserve, 0 where there is no such motion.
  double reserve(const hqp::Problem& tasks, std::span<const Interval> torque,
                 std::span<const Approach> approaches, std::span<const double> known) noexcept;

 private:
  void copy(const hqp::Problem& tasks, int from, int to, double need) noexcept;

  int fixed_, limits_, first_motor_, motors_;
  hqp::Problem problem_;
  hqp::Solver solver_;
  hqp::Solution solution_;
  std::vector<double> coefficients_;  ///< scratch, one row
};

}  // namespace hg::rendering

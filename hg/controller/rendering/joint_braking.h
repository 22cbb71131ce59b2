/// Reserve with which the device can brake before all its limits together.
///
/// Ours; docs/concepts/law.md, "Braking together". Limit k at speed v towards an end that is d away
/// needs a deceleration of n_k = v^2 / (2 d) to stop in front of it. The reserve is the largest mu
/// for which there is one motion of device and twin with
///   - the handle on the twin, and the gantry within what its drives can follow,
///   - every motor within its allowed torque,
///   - and C_k ddq <= room_k - mu n_k for every limit k, mirrored for lower ends,
/// where room_k >= 0 is the acceleration still allowed to limit k because its end is far.
/// With mu >= 1 the device stops before all of them; each n_k then stays as it is or shrinks.
/// No allocation after construction.
#pragma once

#include <span>
#include <vector>

#include "hg/core/interval.h"
#include "hg/hqp/solver.h"
#include "hg/limits/acceleration_bounds.h"

namespace hg::rendering {

inline constexpr double kMostReserve = 100.0;  ///< Largest reserve that is reported
inline constexpr double kLeastReserve = 1.6;   ///< Reserve for changes of posture, hand and delays

/// A coordinate on its way to an end of its limits.
struct Approach {
  double need = 0.0;   ///< Needed deceleration, rad/s^2 or m/s^2; > 0: upper end, < 0: lower end
  Interval room;       ///< Allowed accelerations while nothing has to brake; holds 0
  double known = 0.0;  ///< Acceleration without the unknowns
};

/// Approach of `q` with speed `dq` to the ends of `limits`. The room is that of bounds R with a
/// fixed part of ddq_max, extended to hold 0.
Approach approach(const limits::JointLimits& limits, const limits::RecoverableOptions& options,
                  double q, double dq, double dt) noexcept;

/// Whether the need is large enough to check the reserve.
bool is_near(const Approach& approach, const limits::JointLimits& limits) noexcept;

/// Narrows `bounds` on acceleration so that all limits that need it brake together, once `reserve`
/// has fallen to what changes of posture may use up. Never empty.
Interval braking_bounds(const Approach& approach, double reserve, Interval bounds,
                        const limits::JointLimits& limits,
                        const limits::RecoverableOptions& options, double dq) noexcept;

class JointBraking {
 public:
  /// Uses `tasks`: rows 0 .. fixed - 1 always hold; `rows` are those of the limits, of which
  /// `motors` from `first_motor` on are rows of motors and not approached.
  JointBraking(const hqp::Problem& tasks, int fixed, std::vector<int> rows, int first_motor,
               int motors);

  /// Returns the reserve: at most kMostReserve, 0 where there is no such motion. `tasks` has this
  /// cycle's rows; `torque` holds the bounds of the motors' rows, `approaches` those of all limits
  /// (motors: not read), `joint_room` the room of those before the motors, in place of that in
  /// `approaches`.
  double reserve(const hqp::Problem& tasks, std::span<const Interval> torque,
                 std::span<const Approach> approaches,
                 std::span<const Interval> joint_room) noexcept;

 private:
  void copy(const hqp::Problem& tasks, int from, int to, double need) noexcept;

  int fixed_;
  std::vector<int> rows_;
  int first_motor_, motors_;
  hqp::Problem problem_;
  hqp::Solver solver_;
  hqp::Solution solution_;
  std::vector<double> coefficients_;  ///< scratch, one row
};

}  // namespace hg::rendering

/// Last hand on the command: takes out of it what would bring the device beyond its limits, and
/// leaves what is fine untouched, bit for bit.
///
/// Source: [HANDBOOK] 6.3, with the torque of the joint's spring as the one that holds its motor:
/// it is measured, so that no model of the arm can be wrong here. A motor that gets it keeps its
/// speed. With joint torque t_h (0 in strict mode), margin m and deceleration A that can be relied
/// on, upper side, lower side is the mirror:
///   q >= hi + m                 tau <= t_h                the part that pushes on is cut
///   v^2 > 2 A (hi + m - q)      tau <= t_h - Jm A         the joint is made to brake
///   v >= 1.05 V                 tau <= t_h                the part that accelerates is cut
///   always                      |tau| <= peak, and |tau - t_h| grows no faster than the rise time
/// Outside the braking zone |tau - t_h| never grows and never changes its sign, and doing it twice
/// changes nothing. Drives that take positions: the same for q and q'. Gantry: speed and range.
///
/// No allocation, noexcept after set-up. Not a certified safety function.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/safety/monitor.h"
#include "hg/signals/state.h"

namespace hg::safety {

/// Set-up data.
struct SanitiserConfig {
  bool is_strict = false;      ///< cut to 0 instead of to the torque that holds
  double margin = 5e-3;        ///< beyond the limit of a revolute joint, rad
  double slide_margin = 5e-3;  ///< beyond the limit of a prismatic joint, m
  double torque_rise = 3e-4;   ///< from none to peak torque, s; slower would touch what is fine
};

/// What the sanitiser compares a command with.
struct SanitiserInput {
  const RobotState& robot;
  bool was_on = false;        ///< the command before had the drives on; the rest belongs to it
  const VectorM& q_before;    ///< its positions
  const VectorM& tau_before;  ///< its torques; empty without torque control
};

struct Sanitised {
  Fault fault;                ///< kCommandNotFinite with the index of the component; drives are off
  std::uint32_t changed = 0;  ///< bit i: joint i; from bit 16 on: axes of the gantry
};

class Sanitiser {
 public:
  /// Limits and ratings are those of `monitor`, with one entry per joint.
  Sanitiser(const SanitiserConfig& config, const MonitorConfig& monitor);

  Sanitised step(const SanitiserInput& input, CommandFrame& command) const noexcept;

 private:
  struct Joint {
    double lowest, highest;  // with the margin
    double speed, braking, peak, rotor_inertia;
  };

  double torque(const Joint& joint, double q, double dq, double hold, double before, bool was_on,
                double tau) const noexcept;
  bool limit_position(const Joint& joint, double q, double before, bool was_on, double& q_cmd,
                      double& dq_cmd) const noexcept;

  SanitiserConfig config_;
  double dt_;
  std::vector<Joint> joints_;
  double gantry_speed_;
  std::vector<Interval> gantry_range_;
};

}  // namespace hg::safety

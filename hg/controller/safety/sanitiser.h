/// Last check of the command: removes what would drive the device beyond its limits and leaves
/// everything else unchanged, bit for bit.
///
/// Source: [HANDBOOK] 6.3, where the torque holding a motor is the measured torque of its spring,
/// so that no model of the arm is needed; with it the motor keeps its speed. With joint torque t_h
/// (0 in strict mode), margin m and reliable deceleration A, at the upper end (lower end mirrored):
///   q >= hi + m                 tau <= t_h                the part that pushes on is cut
///   v^2 > 2 A (hi + m - q)      tau <= t_h - Jm A         the joint is made to brake
///   v >= 1.05 V                 tau <= t_h                the part that accelerates is cut
///   always                      |tau| <= peak, and |tau - t_h| grows no faster than the rise time
/// Outside the braking zone |tau - t_h| never grows and never changes its sign. Applying step()
/// twice changes nothing. Drives that take positions: the same for q and q'. Gantry: speed and
/// range.
///
/// No allocation, noexcept after set-up. Not a certified safety function.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/controller/safety/sanitiser_config.h"
#include "hg/model/device_model.h"
#include "hg/signals/state.h"

namespace hg::safety {

/// Measured state and previous command with which a command is compared.
struct SanitiserInput {
  const RobotState& robot;
  bool was_on = false;  ///< The previous command had the drives on; the fields below belong to it
  const VectorM& q_before;    ///< Positions of the previous command, rad or m
  const VectorM& tau_before;  ///< Torques of the previous command; empty without torque control
};

struct Sanitised {
  Fault fault;  ///< kCommandNotFinite with the index of the component, drives off; or kNone
  /// Changed entries: bit i: joint i; from bit 16 on: axes of the gantry.
  std::uint32_t changed = 0;
};

class Sanitiser {
 public:
  /// `gantry_speed`: largest speed of a gantry axis, m/s or rad/s.
  Sanitiser(const SanitiserConfig& config, const DeviceModel& device, double gantry_speed);

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

#include "hg/controller/safety/sanitiser.h"

#include <algorithm>
#include <cmath>

#include "hg/core/first_not_finite.h"

namespace hg::safety {
namespace {

constexpr double kSpeedShare = 1.05;            // of the rating, from which accelerating is cut
constexpr double kBrakingShare = 1.5;           // of the rating: the bounds brake with no more
constexpr double kBrakingWithoutRating = 10.0;  // rad/s^2 or m/s^2
constexpr unsigned kFirstGantryBit = 16;

void switch_off(CommandFrame& command) noexcept {
  disable(command);
  for (double& q : command.q_m) q = std::isfinite(q) ? q : 0.0;
}

// `value` limited to `reach` around `before`, extended to `rest`
double within_reach(double value, double before, double reach, double rest) noexcept {
  return std::clamp(value, std::min(before - reach, rest), std::max(before + reach, rest));
}

}  // namespace

Sanitiser::Sanitiser(const SanitiserConfig& config, const DeviceModel& device, double gantry_speed)
    : config_(config),
      dt_(device.dt()),
      gantry_speed_(gantry_speed),
      gantry_range_(device.gantry_range) {
  for (std::size_t i = 0; i < device.joint_limits.size(); ++i) {
    const double margin =
        device.is_slide(static_cast<int>(i)) ? config.slide_margin : config.margin;
    const limits::JointLimits& limits = device.joint_limits[i];
    const bool is_rated = std::isfinite(limits.ddq_max);
    const bool has_motor = !device.actuators.empty();
    joints_.push_back({.lowest = limits.q_min - margin,
                       .highest = limits.q_max + margin,
                       .speed = kSpeedShare * limits.dq_max,
                       .braking = is_rated ? kBrakingShare * limits.ddq_max : kBrakingWithoutRating,
                       .peak = has_motor ? device.actuators[i].torque_max : kInfinity,
                       .rotor_inertia = has_motor ? device.actuators[i].rotor_inertia : 0.0});
  }
}

Sanitised Sanitiser::step(const SanitiserInput& input, CommandFrame& command) const noexcept {
  Sanitised result;
  const int index =
      first_not_finite(command.q_m, command.dq_m, command.ddq_m, command.tau_m, command.dq_p);
  if (index >= 0) {
    switch_off(command);
    result.fault = {FaultCode::kCommandNotFinite, static_cast<std::int16_t>(index), NAN, 0.0};
    return result;
  }
  const RobotState& robot = input.robot;
  const bool has_torques = command.tau_m.size() > 0;
  for (int i = 0; command.enable && i < command.q_m.size(); ++i) {
    const Joint& joint = joints_[i];
    const bool was_on = input.was_on;
    bool is_changed = false;
    if (has_torques) {
      const bool has_hold = !config_.is_strict && robot.tau_m.size() > 0;
      const double tau = torque(joint, robot.q_m[i], robot.dq_m[i], has_hold ? robot.tau_m[i] : 0.0,
                                was_on ? input.tau_before[i] : 0.0, was_on, command.tau_m[i]);
      is_changed = tau != command.tau_m[i];
      if (is_changed) command.tau_m[i] = tau;
    } else {
      is_changed = limit_position(joint, robot.q_m[i], was_on ? input.q_before[i] : 0.0, was_on,
                                  command.q_m[i], command.dq_m[i]);
    }
    if (is_changed) result.changed |= 1U << static_cast<unsigned>(i);
  }
  for (int axis = 0; axis < command.dq_p.size(); ++axis) {
    double dq = std::clamp(command.dq_p[axis], -gantry_speed_, gantry_speed_);
    const bool has_range = axis < robot.q_p.size() && command.enable;
    if (has_range && robot.q_p[axis] >= gantry_range_[axis].ub) {
      dq = std::min(dq, 0.0);
    }
    if (has_range && robot.q_p[axis] <= gantry_range_[axis].lb) {
      dq = std::max(dq, 0.0);
    }
    if (dq == command.dq_p[axis]) continue;
    command.dq_p[axis] = dq;
    result.changed |= 1U << (kFirstGantryBit + static_cast<unsigned>(axis));
  }
  return result;
}

double Sanitiser::torque(const Joint& joint, double q, double dq, double hold, double before,
                         bool was_on, double tau) const noexcept {
  const double brake = joint.rotor_inertia * joint.braking;
  hold = std::clamp(hold, -joint.peak, joint.peak);
  double most = joint.peak, least = -joint.peak;
  const auto needs_braking = [&](double distance) {
    return dq * dq > 2.0 * joint.braking * std::max(0.0, distance);
  };
  if (q >= joint.highest || dq >= joint.speed) most = std::min(most, hold);
  if (q <= joint.lowest || dq <= -joint.speed) least = std::max(least, hold);
  if (dq > 0.0 && needs_braking(joint.highest - q)) most = std::min(most, hold - brake);
  if (dq < 0.0 && needs_braking(q - joint.lowest)) least = std::max(least, hold + brake);
  most = std::max(most, -joint.peak);
  least = std::min(least, joint.peak);
  const double limited = std::max(std::min(tau, most), least);
  if (!was_on) return limited;
  const double reach = joint.peak * dt_ / config_.torque_rise;
  return within_reach(limited, before, reach, hold);
}

// The measured position is always allowed, and everything between it and the range.
bool Sanitiser::limit_position(const Joint& joint, double q, double before, bool was_on,
                               double& q_cmd, double& dq_cmd) const noexcept {
  double position = std::clamp(q_cmd, std::min(joint.lowest, q), std::max(joint.highest, q));
  if (was_on) position = within_reach(position, before, joint.speed * dt_, q);
  double speed = std::clamp(dq_cmd, -joint.speed, joint.speed);
  if (position >= joint.highest) speed = std::min(speed, 0.0);
  if (position <= joint.lowest) speed = std::max(speed, 0.0);
  const bool is_changed = position != q_cmd || speed != dq_cmd;
  q_cmd = position;
  dq_cmd = speed;
  return is_changed;
}

}  // namespace hg::safety

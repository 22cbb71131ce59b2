#include "hg/controller/rendering/motor_torque.h"

#include <algorithm>
#include <cmath>

namespace hg::rendering {
namespace {

// upper end of reached_torque()
double reached_end(double end, double light, double before, double dt) noexcept {
  const double fast = std::min(dt / kTorqueOnset, 1.0);
  const double slow = std::min(dt / kHeavyOnset, 1.0);
  if (before >= end) return before + fast * (end - before);
  const double turn = std::clamp(light, before, end);
  return before + fast * (turn - before) + slow * (end - turn);
}

}  // namespace

Interval allowed_torque(const ActuatorModel& motor, double dq) noexcept {
  const double speed = std::abs(dq);
  const double braking = kTorqueShare * motor.torque_max;
  const double friction = motor.coulomb_friction + motor.viscous_friction * speed;
  const double moving = kTorqueShare * torque_available(motor, dq) - friction;
  // friction has its full size and its sign only where the joint moves
  const double share = std::min(speed / motor.stribeck_speed, 1.0);
  const double onward = braking + share * (moving - braking);
  return dq > 0.0 ? Interval{-braking, onward} : Interval{-onward, braking};
}

Interval reached_torque(Interval allowed, double light, double before, double dt) noexcept {
  const double most = reached_end(allowed.ub, light, before, dt);
  return {std::min(-reached_end(-allowed.lb, light, -before, dt), most), most};
}

bool is_loaded(double most, double held) noexcept {
  constexpr double kLoad = 0.4;  // of the torque: a lighter load builds up in time
  return std::abs(held) > kLoad * most;
}

Interval eased_torque(Interval torque, double most, double light, double held, double led,
                      double before, double dt) noexcept {
  constexpr double kFaster = 4.0;
  if (!is_loaded(most, held)) return torque;
  const Interval fastest = reached_torque({-most, most}, light, before, kFaster * dt);
  if (held > 0.0 && led > held) torque.ub = std::max(torque.ub, std::min(held, fastest.ub));
  if (held < 0.0 && led < held) torque.lb = std::min(torque.lb, std::max(held, fastest.lb));
  return torque;
}

}  // namespace hg::rendering

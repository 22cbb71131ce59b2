#include "hg/device/udp/agreement.h"

#include <fmt/format.h>

#include <cmath>

namespace hg::udp {
namespace {

const char* words(Interface interface) noexcept {
  return interface == Interface::kTorque ? "torques" : "positions";
}

const char* words(bool is_lock_step) noexcept {
  return is_lock_step ? "lock-step (--fast)" : "real time";
}

}  // namespace

std::string difference(const Description& actual, const Description& expected) {
  if (actual.device.bytes != expected.device.bytes) {
    return fmt::format("device: '{}', expected '{}'", actual.device.printable(),
                       expected.device.printable());
  }
  if (actual.n_p != expected.n_p) {
    return fmt::format("gantry axes: {}, expected {}", actual.n_p, expected.n_p);
  }
  if (actual.n_m != expected.n_m) {
    return fmt::format("joints: {}, expected {}", actual.n_m, expected.n_m);
  }
  if (actual.rate_Hz != expected.rate_Hz) {
    return fmt::format("rate: {:g} Hz, expected {:g} Hz", actual.rate_Hz, expected.rate_Hz);
  }
  if (actual.interface != expected.interface) {
    return fmt::format("drives take {}, expected {}", words(actual.interface),
                       words(expected.interface));
  }
  if (actual.is_lock_step != expected.is_lock_step) {
    return fmt::format("time: {}, expected {}", words(actual.is_lock_step),
                       words(expected.is_lock_step));
  }
  return {};
}

bool fits(const Description& agreed, const SensorFrame& sensors) noexcept {
  const auto n_m = static_cast<Eigen::Index>(agreed.n_m);
  // commanding torques requires both sides of the springs
  const bool may_lack = agreed.interface == Interface::kPosition;
  const auto fits_joints = [&](const VectorM& v) {
    return v.size() == n_m || (may_lack && v.size() == 0);
  };
  return sensors.q_m.size() == n_m && sensors.dq_m.size() == n_m && fits_joints(sensors.theta_m) &&
         fits_joints(sensors.tau_m) &&
         sensors.q_p.size() == static_cast<Eigen::Index>(agreed.n_p) &&
         std::isfinite(sensors.time_s) && sensors.q_m.allFinite() && sensors.dq_m.allFinite() &&
         sensors.theta_m.allFinite() && sensors.tau_m.allFinite() && sensors.q_p.allFinite() &&
         sensors.w_S.allFinite() && sensors.a_S.allFinite() && sensors.omega_S.allFinite() &&
         sensors.temperature_m.allFinite();
}

bool fits(const Description& agreed, const CommandFrame& command) noexcept {
  const auto n_m = static_cast<Eigen::Index>(agreed.n_m);
  const bool is_torque = agreed.interface == Interface::kTorque;
  const HandTarget& hand = command.hand_target;
  return command.q_m.size() == n_m && command.dq_m.size() == n_m && command.ddq_m.size() == n_m &&
         command.tau_m.size() == (is_torque ? n_m : 0) &&
         command.dq_p.size() == static_cast<Eigen::Index>(agreed.n_p) && command.q_m.allFinite() &&
         command.dq_m.allFinite() && command.ddq_m.allFinite() && command.tau_m.allFinite() &&
         command.dq_p.allFinite() && hand.p_B.allFinite() && hand.press >= 0.0 && hand.press <= 1.0;
}

CommandFrame off_command(const Description& agreed) {
  const auto n_m = static_cast<Eigen::Index>(agreed.n_m);
  CommandFrame command;
  command.q_m = command.dq_m = command.ddq_m = VectorM::Zero(n_m);
  if (agreed.interface == Interface::kTorque) command.tau_m = VectorM::Zero(n_m);
  command.dq_p = VectorP::Zero(agreed.n_p);
  return command;
}

}  // namespace hg::udp

#include "hg/device/udp/agreement.h"

#include <fmt/format.h>

#include "hg/signals/off_command.h"
#include "hg/signals/sensor_check.h"

namespace hg::udp {
namespace {

const char* words(Interface interface) noexcept {
  switch (interface) {
    case Interface::kPosition:
      return "positions";
    case Interface::kTorque:
      return "torques";
    case Interface::kRemote:
      return "targets of a leader";
  }
  return "what is unknown";
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
  // this side does not know whether the device has an inertial unit: its zeros are finite
  const RequiredSensors required = {.n_p = static_cast<int>(agreed.n_p),
                                    .n_m = static_cast<int>(agreed.n_m),
                                    .has_torque_loop = agreed.interface == Interface::kTorque,
                                    .has_imu = true};
  return check_values(sensors, required).code == FaultCode::kNone;
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
  return hg::off_command(static_cast<int>(agreed.n_p), static_cast<int>(agreed.n_m),
                         agreed.interface == Interface::kTorque);
}

}  // namespace hg::udp

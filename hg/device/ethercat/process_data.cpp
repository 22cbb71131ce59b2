#include "hg/device/ethercat/process_data.h"

#include "hg/device/ethercat/bits.h"

namespace hg::ethercat {
namespace {

bool is_unsigned(Input meaning) noexcept {
  return meaning == Input::kStatusWord || meaning == Input::kErrorCode ||
         meaning == Input::kSensorFault || meaning == Input::kSampleCounter;
}

// In SI units.
double value_of(const Entry<Input>& entry, std::uint32_t bits) noexcept {
  const double number = is_unsigned(entry.meaning)
                            ? static_cast<double>(bits)
                            : static_cast<double>(signed_of(bits, entry.bits));
  return entry.scale * number + entry.offset;
}

bool is_within(Input meaning, Input first, Input last) noexcept {
  return first <= meaning && meaning <= last;
}

int distance(Input first, Input meaning) noexcept {
  return static_cast<int>(meaning) - static_cast<int>(first);
}

void set(VectorM& values, int size, int i, double value) noexcept {
  if (values.size() != size) values = VectorM::Zero(size);
  values[i] = value;
}

// State of the slave itself.
void take_state(Input meaning, std::uint32_t bits, Station& station) noexcept {
  switch (meaning) {
    case Input::kStatusWord:
      station.status = static_cast<std::uint16_t>(bits);
      return;
    case Input::kErrorCode:
    case Input::kSensorFault:
      station.error = static_cast<std::uint16_t>(bits);
      return;
    case Input::kModeNow:
      station.mode_now = static_cast<std::uint8_t>(bits);
      return;
    case Input::kSampleCounter:
      station.has_new_samples = bits != station.samples;
      station.samples = bits;
      return;
    default:
      return;
  }
}

// Values of a manipulator joint.
void take_joint(Input meaning, int n_m, int joint, double value, SensorFrame& frame) noexcept {
  switch (meaning) {
    case Input::kLinkPosition:
      return set(frame.q_m, n_m, joint, value);
    case Input::kLinkVelocity:
      return set(frame.dq_m, n_m, joint, value);
    case Input::kMotorPosition:
      return set(frame.theta_m, n_m, joint, value);
    case Input::kJointTorque:
      return set(frame.tau_m, n_m, joint, value);
    case Input::kTemperature:
      return set(frame.temperature_m, n_m, joint, value);
    default:
      return;
  }
}

void take_switch(Input meaning, bool is_set, SensorFrame& frame) noexcept {
  switch (meaning) {
    case Input::kDeadMan:
      frame.dead_man = is_set;
      return;
    case Input::kEmergencyStop:
      frame.safety.emergency_stop = is_set;
      return;
    case Input::kOperatorEnable:
      frame.safety.operator_enable = is_set;
      return;
    case Input::kOverrideKey:
      frame.safety.override_key = is_set;
      return;
    case Input::kFieldClear:
      frame.safety.is_field_clear = is_set;
      return;
    case Input::kInputsDisagree:
      frame.safety.has_disagreement = is_set;
      return;
    default:
      return;
  }
}

// Values of the sensors in the handle.
void take_handle(Input meaning, double value, SensorFrame& frame) noexcept {
  if (is_within(meaning, Input::kForceX, Input::kTorqueZ)) {
    frame.w_S[distance(Input::kForceX, meaning)] = value;
  } else if (is_within(meaning, Input::kAccelerationX, Input::kAccelerationZ)) {
    frame.a_S[distance(Input::kAccelerationX, meaning)] = value;
  } else if (is_within(meaning, Input::kAngularRateX, Input::kAngularRateZ)) {
    frame.omega_S[distance(Input::kAngularRateX, meaning)] = value;
  }
}

// The target of a drive in SI units.
double target(const Slave& slave, Output meaning, int n_p, const Orders& orders,
              const SensorFrame& last) noexcept {
  const int joint = slave.joint - n_p;
  const CommandFrame* command = orders.enables ? orders.command : nullptr;
  switch (meaning) {
    case Output::kTargetPosition:
      if (joint < 0) return last.q_p[slave.joint];
      return command != nullptr ? command->q_m[joint] : last.q_m[joint];
    case Output::kTargetVelocity:
      if (command == nullptr) return 0.0;
      return joint < 0 ? command->dq_p[slave.joint] : command->dq_m[joint];
    case Output::kTargetTorque:
      if (command == nullptr || joint < 0 || joint >= command->tau_m.size()) return 0.0;
      return command->tau_m[joint];
    default:
      return 0.0;
  }
}

std::uint32_t bits_for(const Slave& slave, const Entry<Output>& entry, int n_p,
                       const Orders& orders, const SensorFrame& last) noexcept {
  switch (entry.meaning) {
    case Output::kNothing:
      return 0;
    case Output::kControlWord:
      return orders.control_word;
    case Output::kMode:
      return static_cast<std::uint32_t>(slave.mode);
    case Output::kTargetPosition:
    case Output::kTargetVelocity:
    case Output::kTargetTorque: {
      const double value = target(slave, entry.meaning, n_p, orders, last);
      return rounded((value - entry.offset) / entry.scale, entry.bits);
    }
    case Output::kReset: {
      const bool is_pressed = orders.command != nullptr && orders.command->panel.reset;
      return is_pressed != entry.is_inverted ? 1 : 0;
    }
    case Output::kOpenBrakes:
      return orders.opens_brakes != entry.is_inverted ? 1 : 0;
  }
  return 0;
}

}  // namespace

void take_inputs(const Slave& slave, int n_p, int n_m, Station& station,
                 SensorFrame& frame) noexcept {
  std::uint32_t at = 0;
  const int joint = slave.joint - n_p;
  for (const Entry<Input>& entry : slave.inputs) {
    const std::uint32_t bits = read_bits(station.inputs, at, entry.bits);
    at += entry.bits;
    take_state(entry.meaning, bits, station);
    take_switch(entry.meaning, (bits != 0) != entry.is_inverted, frame);
    take_handle(entry.meaning, value_of(entry, bits), frame);
    if (slave.joint >= 0 && joint >= 0) {
      take_joint(entry.meaning, n_m, joint, value_of(entry, bits), frame);
    } else if (slave.joint >= 0 && entry.meaning == Input::kLinkPosition) {
      if (frame.q_p.size() != n_p) frame.q_p = VectorP::Zero(n_p);
      frame.q_p[slave.joint] = value_of(entry, bits);
    }
  }
}

void put_outputs(const Slave& slave, int n_p, const Orders& orders, const SensorFrame& last,
                 Station& station) noexcept {
  std::uint32_t at = 0;
  for (const Entry<Output>& entry : slave.outputs) {
    write_bits(station.outputs, at, entry.bits, bits_for(slave, entry, n_p, orders, last));
    at += entry.bits;
  }
}

}  // namespace hg::ethercat

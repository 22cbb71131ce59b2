/// Messages with content, for tests.
#pragma once

#include <random>

#include "hg/device/udp/codec.h"

namespace hg::udp {

/// Of a device with two gantry axes and six joints; values from `random`.
template <typename Vector>
void fill(std::mt19937& random, Eigen::Index size, Vector& v) {
  std::uniform_real_distribution<double> value(-10.0, 10.0);
  v.resize(size);
  for (Eigen::Index i = 0; i < size; ++i) v[i] = value(random);
}

inline SensorFrame example_sensors(std::mt19937& random, std::uint64_t sequence) {
  SensorFrame frame;
  frame.sequence = sequence;
  frame.time_s = 1e-3 * static_cast<double>(sequence);
  frame.answered_sequence = sequence - 1;
  frame.dead_man = random() % 2 == 0;
  SafetyInputs& safety = frame.safety;
  for (bool* input : {&safety.emergency_stop, &safety.operator_enable, &safety.override_key,
                      &safety.is_field_clear, &safety.has_disagreement}) {
    *input = random() % 2 == 0;
  }
  frame.bus_errors = static_cast<std::uint32_t>(random());
  frame.driver_fault = random() % 2 == 0 ? FaultCode::kNone : FaultCode::kEmergencyStop;
  for (VectorM* v : {&frame.q_m, &frame.dq_m, &frame.theta_m, &frame.tau_m, &frame.temperature_m}) {
    fill(random, 6, *v);
  }
  fill(random, 2, frame.q_p);
  fill(random, 6, frame.w_S);
  fill(random, 3, frame.a_S);
  fill(random, 3, frame.omega_S);
  return frame;
}

inline CommandFrame example_command(std::mt19937& random, std::uint64_t sequence) {
  CommandFrame command;
  command.sequence = sequence;
  command.enable = random() % 2 == 0;
  for (VectorM* v : {&command.q_m, &command.dq_m, &command.ddq_m, &command.tau_m}) {
    fill(random, 6, *v);
  }
  fill(random, 2, command.dq_p);
  command.hand_target.active = random() % 2 == 0;
  fill(random, 3, command.hand_target.p_B);
  command.hand_target.press = 0.25;
  SafetyPanel& panel = command.panel;
  for (bool* button : {&panel.emergency_stop, &panel.operator_enable, &panel.override_key,
                       &panel.person_in_field, &panel.reset}) {
    *button = random() % 2 == 0;
  }
  return command;
}

/// The same fields with the same bits, as the wire has them.
template <typename Message>
bool same_bits(const Message& a, const Message& b) {
  Datagram one, two;
  encode({}, a, one);
  encode({}, b, two);
  return std::ranges::equal(one.view(), two.view());
}

}  // namespace hg::udp

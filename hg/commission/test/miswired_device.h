/// A machine whose connections are mistaken, around one that is right; for tests.
#pragma once

#include <utility>

#include "hg/device/device.h"

namespace hg::commission {

/// Mistakes of one manipulator joint, and an exchange of two.
struct Miswiring {
  int joint = 0;
  double encoder = 1.0;  ///< Factor of link encoder and its speed
  double motor = 1.0;    ///< Factor of the motor encoder
  double speed = 1.0;    ///< Factor of the speed alone
  double torque = 1.0;   ///< Factor of the torque sensor
  double command = 1.0;  ///< Factor of what is commanded
  double zero = 0.0;  ///< Added to both encoders, and subtracted from the commanded position, rad
  int other = -1;     ///< Joint with which it is swapped; -1: none
  bool swaps_sensors = true, swaps_commands = true;
  double force = 1.0;  ///< Factor of the force sensor
};

class MiswiredDevice final : public device::Device {
 public:
  MiswiredDevice(device::Device& machine, const Miswiring& mistake)
      : machine_(machine), mistake_(mistake) {}

  void read(SensorFrame& sensors) noexcept override {
    machine_.read(sensors);
    const Miswiring& m = mistake_;
    const int i = m.joint;
    sensors.q_m[i] = m.encoder * sensors.q_m[i] + m.zero;
    sensors.dq_m[i] *= m.encoder * m.speed;
    if (sensors.theta_m.size() > i) sensors.theta_m[i] = m.motor * sensors.theta_m[i] + m.zero;
    if (sensors.tau_m.size() > i) sensors.tau_m[i] *= m.torque;
    sensors.w_S *= m.force;
    if (m.other < 0 || !m.swaps_sensors) return;
    for (VectorM* values : {&sensors.q_m, &sensors.dq_m, &sensors.theta_m, &sensors.tau_m}) {
      if (values->size() > 0) std::swap((*values)[i], (*values)[m.other]);
    }
  }

  void write(const CommandFrame& command) noexcept override {
    CommandFrame sent = command;
    const Miswiring& m = mistake_;
    if (m.other >= 0 && m.swaps_commands) {
      for (VectorM* values : {&sent.q_m, &sent.dq_m, &sent.ddq_m, &sent.tau_m}) {
        if (values->size() > 0) std::swap((*values)[m.joint], (*values)[m.other]);
      }
    }
    sent.q_m[m.joint] = m.command * (sent.q_m[m.joint] - m.zero);
    sent.dq_m[m.joint] *= m.command;
    sent.ddq_m[m.joint] *= m.command;
    if (sent.tau_m.size() > 0) sent.tau_m[m.joint] *= m.command;
    machine_.write(sent);
  }

  const Truth* truth() const noexcept override { return machine_.truth(); }

 private:
  device::Device& machine_;
  Miswiring mistake_;
};

}  // namespace hg::commission

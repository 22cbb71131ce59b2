// FILL IN: a machine of one's own. read() and then write() are called once per period. Neither may
// wait, throw or allocate.
#pragma once

#include "hg/device/device.h"

// Yours talks to drives and sensors. This one is made of double integrators whose drives follow the
// reference, and a hand pushes it with 10 N from the first to the second second.
class MyRobot final : public hg::device::Device {
 public:
  MyRobot(const hg::VectorM& q, double period_s)
      : q_(q), dq_(hg::VectorM::Zero(q.size())), period_s_(period_s) {}

  // Units: rad (m), rad/s (m/s), N, Nm; signs and zero positions of the joints as in the URDF.
  void read(hg::SensorFrame& sensors) noexcept override {
    sensors.sequence = ++samples_;
    sensors.answered_sequence = answered_;
    sensors.time_s = period_s_ * static_cast<double>(samples_);
    sensors.q_m = q_;  // joints without limits: in [-pi, pi)
    sensors.dq_m = dq_;
    sensors.dead_man = true;  // the hand holds the handle
    // what the hand does to the handle, at the sensor and in its axes: force, then torque
    sensors.w_S[0] = sensors.time_s > 1.0 && sensors.time_s <= 2.0 ? 10.0 : 0.0;
  }

  // The reference is for the next sample. The last call of a session has `enable` false.
  void write(const hg::CommandFrame& command) noexcept override {
    answered_ = command.sequence;
    hg::VectorM ddq = -1.0 / period_s_ * dq_;  // drives off: the brakes hold
    if (command.enable) {
      ddq = command.ddq_m + 1e4 * (command.q_m - q_) + 200.0 * (command.dq_m - dq_);
    }
    q_ += period_s_ * dq_ + 0.5 * period_s_ * period_s_ * ddq;
    dq_ += period_s_ * ddq;
  }

 private:
  hg::VectorM q_, dq_;  // rad, rad/s
  double period_s_;
  std::uint64_t samples_ = 0, answered_ = 0;
};

// A machine of one's own. Arguments: its device.yaml, and a twin.yaml to put into its hand.
#include <cstdio>

#include "hg/config/control_cycle.h"
#include "hg/runtime/runtime.h"

namespace {

// Yours talks to drives and sensors. This one is made of double integrators whose drives follow the
// reference, and a hand pushes it with 10 N from the first to the second second.
class MyRobot final : public hg::device::Device {
 public:
  MyRobot(const hg::VectorM& q, double period_s)
      : q_(q), dq_(hg::VectorM::Zero(q.size())), period_s_(period_s) {}

  void read(hg::SensorFrame& sensors) noexcept override {
    sensors.sequence = ++samples_;
    sensors.answered_sequence = answered_;
    sensors.time_s = period_s_ * static_cast<double>(samples_);
    sensors.q_m = q_;
    sensors.dq_m = dq_;
    sensors.dead_man = true;  // the hand holds the handle
    sensors.w_S[0] = sensors.time_s > 1.0 && sensors.time_s <= 2.0 ? 10.0 : 0.0;
  }

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

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const hg::config::DeviceConfig device = hg::config::load_device(arguments[1]);
  const hg::config::Twin twin = hg::config::load_twin(arguments[2]);
  hg::controller::Cycle cycle = hg::config::make_cycle(device, twin);
  const hg::VectorM start{{0.0, 0.6, 1.2, 0.0, 0.8, 0.0}};  // rad
  MyRobot robot(start, device.model.dt());

  hg::runtime::Runtime runtime({.duration_s = 2.0}, cycle, robot);
  runtime.start();
  const hg::runtime::RuntimeReport report = runtime.join();
  const hg::VectorM moved = cycle.state().q_m - start;
  std::printf("the joints have moved by up to %.2f rad in %d cycles\n", moved.cwiseAbs().maxCoeff(),
              static_cast<int>(report.cycles));
}

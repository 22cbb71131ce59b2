// A machine of one's own, with a free body of 6 kg in its hand. Argument: the URDF of the machine.
#include <cstdio>

#include "hg/runtime/runtime.h"

namespace {

using hg::model::ChainModel;
constexpr double kPeriod = 1e-3;  // s

// Yours talks to drives and sensors. This one is made of double integrators whose drives follow the
// reference, and a hand pushes it with 10 N from the first to the second second.
class MyRobot final : public hg::device::Device {
 public:
  explicit MyRobot(const hg::VectorM& q) : q_(q), dq_(hg::VectorM::Zero(q.size())) {}

  void read(hg::SensorFrame& sensors) noexcept override {
    sensors.sequence = ++samples_;
    sensors.answered_sequence = answered_;
    sensors.time_s = kPeriod * static_cast<double>(samples_);
    sensors.q_m = q_;
    sensors.dq_m = dq_;
    sensors.dead_man = true;  // the hand holds the handle
    sensors.w_S[0] = samples_ > 1000 && samples_ <= 2000 ? 10.0 : 0.0;
  }

  void write(const hg::CommandFrame& command) noexcept override {
    answered_ = command.sequence;
    hg::VectorM ddq = -1.0 / kPeriod * dq_;  // drives off: the brakes hold
    if (command.enable) {
      ddq = command.ddq_m + 1e4 * (command.q_m - q_) + 200.0 * (command.dq_m - dq_);
    }
    q_ += kPeriod * dq_ + 0.5 * kPeriod * kPeriod * ddq;
    dq_ += kPeriod * ddq;
  }

 private:
  hg::VectorM q_, dq_;  // rad, rad/s
  std::uint64_t samples_ = 0, answered_ = 0;
};

hg::rendering::TwinModel free_body_at(const hg::Pose& handle) {
  hg::rendering::TwinModel twin{.chain = ChainModel::free_body({.mass = 6.0}, {.gravity = false})};
  twin.end_effector = twin.chain.frame("handle");
  twin.q_start.resize(7);
  twin.q_start << handle.p, Eigen::Quaterniond(handle.R).coeffs();
  twin.dofs.resize(6);
  return twin;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  hg::rendering::DeviceModel model{.chain = ChainModel::from_urdf_file(arguments[1])};
  model.n_m = model.chain.nv();
  model.handle = model.chain.frame("handle");
  hg::controller::Config config;  // drives that follow positions; everything else by default
  config.estimation.wrench.has_imu = false;
  for (const hg::model::Joint& joint : model.chain.joints()) {
    model.joint_limits.push_back({.q_min = joint.position.lb,
                                  .q_max = joint.position.ub,
                                  .dq_max = joint.velocity_max,
                                  .ddq_max = 20.0});
    config.monitor.joint_range.push_back(joint.position);
    config.monitor.joint_speed_max.push_back(joint.velocity_max);
  }

  const Eigen::VectorXd start{{0.0, 0.6, 1.2, 0.0, 0.8, 0.0}};  // rad
  hg::model::ChainData posture(model.chain);
  posture.update_poses(start);
  const hg::Pose before = posture.pose(model.handle);
  MyRobot robot(start);
  hg::controller::Cycle cycle(config, model, free_body_at(before));
  hg::runtime::Runtime runtime({.rate_Hz = 1.0 / kPeriod, .duration_s = 2.0}, cycle, robot);
  runtime.start();
  const hg::runtime::Report report = runtime.join();

  const Eigen::Vector3d after = cycle.state().rendering.twin.q_a.head<3>();
  std::printf("the handle has moved by %.2f m in %d cycles\n", (after - before.p).norm(),
              static_cast<int>(report.cycles));
}

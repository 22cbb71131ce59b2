/// A device that follows perfectly, and a cycle for it: for tests of sessions and runtimes.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "hg/controller/cycle.h"
#include "hg/controller/cycle_config.h"
#include "hg/controller/rendering/test/test_models.h"
#include "hg/device/device.h"

namespace hg::runtime {

inline const VectorM kPosture = rendering::posture({0.3, 1.5, -0.6, 1.3, 0.2, 0.4});

// Follows perfectly; the gantry stands still on any command.
class StillDevice : public device::Device {
 public:
  StillDevice() {
    sensors_.q_m = kPosture;
    sensors_.dq_m = VectorM::Zero(6);
    sensors_.q_p = VectorP::Zero(2);
    sensors_.dead_man = true;
  }
  void read(SensorFrame& sensors) noexcept override {
    sensors_.dq_m[0] = speed;
    sensors = sensors_;
  }
  void write(const CommandFrame& command) noexcept override {
    ++sensors_.sequence;
    sensors_.time_s += period_s;
    if (sensors_.sequence == lost_sample) ++sensors_.sequence;
    sensors_.dead_man = !(sensors_.sequence >= opens_at && sensors_.sequence < closes_at);
    if (sensors_.sequence == stalls_at) stall();
    last_target = command.hand_target;
    last_command = command;
    was_enabled |= command.enable;
  }

  bool is_clock() const noexcept override { return keeps_time; }
  // works hard: a device that slept would break the promise of write()
  void stall() const noexcept {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(25);
    while (std::chrono::steady_clock::now() < end) {
    }
  }

  double period_s = 1e-3;
  bool keeps_time = false;
  std::uint64_t lost_sample = 0;
  double speed = 0.0;                         ///< measured speed, for any command
  std::uint64_t stalls_at = 0;                ///< sample during which write() takes 25 ms
  std::uint64_t opens_at = 0, closes_at = 0;  ///< samples with an open dead-man
  CommandFrame last_command;
  bool was_enabled = false;
  HandTarget last_target;

 private:
  SensorFrame sensors_;
};

struct Parts {
  StillDevice device;
  std::unique_ptr<controller::Cycle> cycle;

  explicit Parts(double rate_Hz = 1000.0) {
    DeviceModel model = rendering::unlimited_device();
    model.rate_Hz = rate_Hz;
    model.joint_limits.assign(6, {.q_min = -10.0, .q_max = 10.0, .dq_max = 10.0});
    device.period_s = 1.0 / rate_Hz;
    rendering::TwinModel twin =
        rendering::unlimited_twin(model::ChainModel::free_body({}, {.gravity = false}), "handle");
    twin.q_start =
        rendering::floating_at(rendering::handle_pose(model, Eigen::Vector2d::Zero(), kPosture));
    controller::CycleConfig config;
    config.estimation.wrench.has_imu = false;
    cycle = std::make_unique<controller::Cycle>(config, model, twin);
  }
};

}  // namespace hg::runtime

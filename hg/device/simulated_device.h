/// The simulation behind the device boundary.
#pragma once

#include <utility>

#include "hg/device/device.h"
#include "hg/simulation/simulation.h"

namespace hg::device {

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(simulation::Simulation simulation)
      : simulation_(std::move(simulation)) {}

  void read(SensorFrame& sensors) noexcept override { sensors = simulation_.sensors(); }
  void write(const CommandFrame& command) noexcept override { simulation_.step(command); }
  const Truth* truth() const noexcept override { return &simulation_.truth(); }

 private:
  simulation::Simulation simulation_;
};

}  // namespace hg::device

#include "hg/simulator/simulated_device.h"

#include <utility>

namespace hg::simulator {

SimulatedDevice::SimulatedDevice(Simulation simulation) : simulation_(std::move(simulation)) {}

void SimulatedDevice::read(SensorFrame& sensors) noexcept { sensors = simulation_.sensors(); }

void SimulatedDevice::write(const CommandFrame& command) noexcept {
  simulation_.step(command, faults_);
}

const Truth* SimulatedDevice::truth() const noexcept { return &simulation_.truth(); }

}  // namespace hg::simulator

#include "hg/simulator/simulated_device.h"

#include <utility>

namespace hg::simulator {

SimulatedDevice::SimulatedDevice(Simulation simulation, faults::Injector injector)
    : simulation_(std::move(simulation)), injector_(std::move(injector)) {}

void SimulatedDevice::read(SensorFrame& sensors) noexcept {
  sensors = simulation_.sensors();
  injector_.spoil(sensors);
}

void SimulatedDevice::write(const CommandFrame& command) noexcept {
  arrived_ = command;
  injector_.spoil(arrived_);
  simulation_.step(arrived_, injector_.hardware());
}

const Truth* SimulatedDevice::truth() const noexcept { return &simulation_.truth(); }

void SimulatedDevice::spoil(OperatorFrame& input) const noexcept { injector_.spoil(input); }

}  // namespace hg::simulator

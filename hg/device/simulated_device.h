/// The simulation behind the device boundary, and faults on purpose between the two.
#pragma once

#include <utility>

#include "hg/device/device.h"
#include "hg/injection/injector.h"
#include "hg/simulation/simulation.h"

namespace hg::device {

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(simulation::Simulation simulation, injection::Injector injector = {})
      : simulation_(std::move(simulation)), injector_(std::move(injector)) {}

  void read(SensorFrame& sensors) noexcept override {
    sensors = simulation_.sensors();
    injector_.spoil(sensors);
  }
  void write(const CommandFrame& command) noexcept override {
    arrived_ = command;
    injector_.spoil(arrived_);
    simulation_.step(arrived_, injector_.hardware());
  }
  const Truth* truth() const noexcept override { return &simulation_.truth(); }
  void spoil(OperatorFrame& input) const noexcept override { injector_.spoil(input); }

 private:
  simulation::Simulation simulation_;
  injection::Injector injector_;  ///< faults on purpose
  CommandFrame arrived_;
};

}  // namespace hg::device

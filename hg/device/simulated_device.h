/// The simulation behind the device boundary, and faults on purpose between the two.
#pragma once

#include "hg/device/device.h"
#include "hg/injection/injector.h"
#include "hg/simulation/simulation.h"

namespace hg::device {

class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(simulation::Simulation simulation, injection::Injector injector = {});

  void read(SensorFrame& sensors) noexcept override;
  void write(const CommandFrame& command) noexcept override;
  const Truth* truth() const noexcept override;
  void spoil(OperatorFrame& input) const noexcept override;

 private:
  simulation::Simulation simulation_;
  injection::Injector injector_;  ///< faults on purpose
  CommandFrame arrived_;
};

}  // namespace hg::device

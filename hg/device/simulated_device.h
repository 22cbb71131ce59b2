/// Simulation behind the device interface, with fault injection in between.
#pragma once

#include "hg/device/device.h"
#include "hg/injection/injector.h"
#include "hg/simulation/simulation.h"

namespace hg::device {

/// Simulated machine with injected faults.
class SimulatedDevice final : public Device {
 public:
  explicit SimulatedDevice(simulation::Simulation simulation, injection::Injector injector = {});

  void read(SensorFrame& sensors) noexcept override;
  void write(const CommandFrame& command) noexcept override;
  const Truth* truth() const noexcept override;
  void spoil(OperatorFrame& input) const noexcept override;

 private:
  simulation::Simulation simulation_;
  injection::Injector injector_;  ///< Injected faults
  CommandFrame arrived_;          ///< Command after injected faults
};

}  // namespace hg::device

/// Simulation behind the device interface, with fault injection in between.
#pragma once

#include "hg/device/device.h"
#include "hg/simulator/faults/injector.h"
#include "hg/simulator/simulation.h"

namespace hg::simulator {

/// Simulated machine with injected faults.
class SimulatedDevice final : public device::Device {
 public:
  explicit SimulatedDevice(Simulation simulation, faults::Injector injector = {});

  void read(SensorFrame& sensors) noexcept override;
  void write(const CommandFrame& command) noexcept override;
  const Truth* truth() const noexcept override;
  void spoil(OperatorFrame& input) const noexcept override;

 private:
  Simulation simulation_;
  faults::Injector injector_;  ///< Injected faults
  CommandFrame arrived_;       ///< Command after injected faults
};

}  // namespace hg::simulator

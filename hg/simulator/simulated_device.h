/// Simulation behind the device interface.
#pragma once

#include "hg/device/device.h"
#include "hg/simulator/hardware_faults.h"
#include "hg/simulator/simulation.h"

namespace hg::simulator {

/// Simulated machine. faults::FaultyDevice injects faults into it.
class SimulatedDevice final : public device::Device {
 public:
  explicit SimulatedDevice(Simulation simulation);

  void read(SensorFrame& sensors) noexcept override;
  void write(const CommandFrame& command) noexcept override;
  const Truth* truth() const noexcept override;

  /// Sets the faults of the hardware from the next write() on.
  void set_hardware_faults(const HardwareFaults& faults) noexcept { faults_ = faults; }

 private:
  Simulation simulation_;
  HardwareFaults faults_;
};

}  // namespace hg::simulator

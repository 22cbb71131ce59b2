/// A device with injected faults: what a run would meet on a machine that fails.
#pragma once

#include <memory>
#include <vector>

#include "hg/device/device.h"
#include "hg/simulator/faults/injector.h"
#include "hg/simulator/simulated_device.h"

namespace hg::faults {

/// Decorator of a device: injects faults into its samples and into the commands to it.
class FaultyDevice final : public device::Device {
 public:
  /// Throws SetupError for a fault of the hardware, which only a simulated machine can have.
  FaultyDevice(std::unique_ptr<device::Device> device, const std::vector<Injection>& injections);
  /// A simulated machine: faults of its hardware are injected, too.
  FaultyDevice(std::unique_ptr<simulator::SimulatedDevice> device,
               const std::vector<Injection>& injections);

  void read(SensorFrame& sensors) noexcept override;
  void write(const CommandFrame& command) noexcept override;
  const Truth* truth() const noexcept override { return device_->truth(); }
  bool is_clock() const noexcept override { return device_->is_clock(); }

 private:
  std::unique_ptr<device::Device> device_;
  simulator::SimulatedDevice* machine_ = nullptr;  ///< device_ where it is simulated
  Injector injector_;
  CommandFrame arrived_;  ///< Command after injected faults
};

}  // namespace hg::faults

#include "hg/simulator/faults/faulty_device.h"

#include <string>
#include <utility>

#include "hg/core/error.h"

namespace hg::faults {

FaultyDevice::FaultyDevice(std::unique_ptr<device::Device> device,
                           const std::vector<Injection>& injections)
    : device_(std::move(device)), injector_(injections) {
  for (const Injection& injection : injections) {
    if (!is_of_hardware(injection)) continue;
    throw SetupError(std::string(injection.kind->name) + ": only a simulated machine can have it");
  }
}

FaultyDevice::FaultyDevice(std::unique_ptr<simulator::SimulatedDevice> device,
                           const std::vector<Injection>& injections)
    : machine_(device.get()), injector_(injections) {
  device_ = std::move(device);
}

void FaultyDevice::read(SensorFrame& sensors) noexcept {
  device_->read(sensors);
  injector_.inject(sensors);
}

void FaultyDevice::write(const CommandFrame& command) noexcept {
  arrived_ = command;
  injector_.inject(arrived_);
  if (machine_ != nullptr) machine_->set_hardware_faults(injector_.hardware());
  device_->write(arrived_);
}

}  // namespace hg::faults

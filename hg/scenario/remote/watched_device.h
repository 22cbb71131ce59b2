/// A simulated device whose true state is watched while a controller elsewhere drives it.
#pragma once

#include <memory>
#include <string>

#include "hg/device/device.h"
#include "hg/model/device_model.h"

namespace hg::scenario {

class WatchedDevice final : public device::Device {
 public:
  /// `device` has a truth(); `model` must outlive this.
  WatchedDevice(std::unique_ptr<device::Device> device, const DeviceModel& model);

  void read(SensorFrame& sensors) noexcept override { device_->read(sensors); }
  void write(const CommandFrame& command) noexcept override;

  /// True state at the end of the session.
  const Truth& truth_now() const noexcept { return *device_->truth(); }

  /// True maxima as text: "joint limits exceeded by at most 0.31e-3 rad or m (m4); force of the
  /// user at most 38.2 N".
  std::string truth_text() const;

 private:
  std::unique_ptr<device::Device> device_;
  const DeviceModel& model_;
  double worst_excess_ = 0.0, max_force_ = 0.0;
  int worst_joint_ = -1;
};

}  // namespace hg::scenario

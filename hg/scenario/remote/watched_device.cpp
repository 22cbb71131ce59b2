#include "hg/scenario/remote/watched_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace hg::scenario {

WatchedDevice::WatchedDevice(std::unique_ptr<device::Device> device, const DeviceModel& model)
    : device_(std::move(device)), model_(model) {}

void WatchedDevice::write(const CommandFrame& command) noexcept {
  device_->write(command);
  const Truth& truth = *device_->truth();
  for (int i = 0; i < truth.q_m.size(); ++i) {
    const limits::JointLimits& limits = model_.joint_limits[i];
    const double q = truth.q_m[i];
    const double excess = std::max(limits.q_min - q, q - limits.q_max);
    if (excess <= worst_excess_) continue;
    worst_excess_ = excess;
    worst_joint_ = i;
  }
  max_force_ = std::max(max_force_, truth.w_H.head<3>().norm());
}

std::string WatchedDevice::truth_text() const {
  std::string limits = "joint limits held";
  if (worst_joint_ >= 0) {
    limits =
        fmt::format("joint limits exceeded by at most {:.2f}e-3 rad or m ({})", 1e3 * worst_excess_,
                    model_.chain.joints()[model_.n_p + worst_joint_].name);
  }
  return fmt::format("{}; force of the user at most {:.1f} N", limits, max_force_);
}

}  // namespace hg::scenario

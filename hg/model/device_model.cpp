#include "hg/model/device_model.h"

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"
#include "hg/model/urdf.h"

namespace hg {

void check_device_model(const DeviceModel& device) {
  const auto require = [](bool ok, const std::string& text) {
    if (!ok) throw SetupError(text);
  };
  const std::size_t n_p = device.n_p, n_m = device.n_m;
  require(device.rate_Hz >= 100.0 && device.rate_Hz <= 20000.0,
          "rate_Hz: must be 100..20000, got " + model::to_text(device.rate_Hz));
  require(device.n_p <= kMaxGantry && device.n_m <= kMaxManipulator &&
              device.n_p + device.n_m == device.chain.nv(),
          "device: gantry and manipulator must be all joints of the chain");
  require(device.gantry_range.size() == n_p, "device: one range per gantry axis is needed");
  for (const Interval& range : device.gantry_range) {
    require(!range.empty(), "device: ranges of the gantry must not be reversed");
  }
  require(device.joint_limits.size() == n_m, "device: one limit per manipulator joint is needed");
  require(device.actuators.empty() || device.actuators.size() == n_m,
          "device: one actuator per manipulator joint is needed, or none");
  require(std::lround(device.drive.dead_time / device.dt()) <= CommandDelay::kMaxPeriods,
          "drive.dead_time_s: at most " + std::to_string(CommandDelay::kMaxPeriods) +
              " periods, got " + model::to_text(device.drive.dead_time) + " s at " +
              model::to_text(device.rate_Hz) + " Hz");
}

std::array<limits::JointLimits, 3> handle_limits(const DeviceModel& device) {
  std::array<limits::JointLimits, 3> combined;
  for (const CartesianLimit& limit : device.cartesian_limits) {
    if (limit.frame != device.handle) continue;
    for (std::size_t axis = 0; axis < combined.size(); ++axis) {
      const limits::JointLimits& more = limit.axes[axis];
      limits::JointLimits& all = combined[axis];
      all.q_min = std::max(all.q_min, more.q_min);
      all.q_max = std::min(all.q_max, more.q_max);
      all.dq_max = std::min(all.dq_max, more.dq_max);
      all.ddq_max = std::min(all.ddq_max, more.ddq_max);
    }
  }
  return combined;
}

}  // namespace hg

#include "hg/controller/rendering/device_model.h"

#include <algorithm>

namespace hg::rendering {

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

}  // namespace hg::rendering

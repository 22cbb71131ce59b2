#include "hg/config/torque_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/random.h"

namespace hg::config {
namespace {

constexpr int kMostDraws = 1'000'000;  // of a posture; takes less than a second

}  // namespace

std::vector<Eigen::VectorXd> random_postures(const DeviceModel& device, int count,
                                             std::uint32_t seed) {
  Random32 random(seed);
  std::vector<Eigen::VectorXd> postures;
  for (int k = 0; k < kMostDraws; ++k) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(device.n_p + device.n_m);
    for (int i = 0; i < device.n_m; ++i) {
      const limits::JointLimits& joint = device.joint_limits[i];
      const double lo = std::max(joint.q_min, -std::numbers::pi);
      const double hi = std::min(joint.q_max, std::numbers::pi);
      const double share = random.share();
      q[device.n_p + i] = lo + (hi - lo) * share;
    }
    const auto is_within = [&](const VirtualJoint& joint) {
      const double sum = joint.weights.dot(q.tail(device.n_m));
      return joint.limits.q_min <= sum && sum <= joint.limits.q_max;
    };
    if (!std::ranges::all_of(device.virtual_joints, is_within)) continue;
    postures.push_back(std::move(q));
    if (static_cast<int>(postures.size()) == count) return postures;
  }
  throw SetupError(fmt::format(
      "virtual_joints: only {} of {} random postures within the limits of the joints keep these "
      "limits, {} are needed to check that the torque loop is stable: widen them, or tighten those "
      "of the joints",
      postures.size(), kMostDraws, count));
}

tracking::Loop torque_loop(const DeviceConfig& device) {
  return {.config = device.control,
          .filters = {.link_pole_Hz = device.estimation.link_pole_Hz,
                      .motor_low_pass_Hz = device.estimation.motor_low_pass_Hz},
          .device = device.model};
}

}  // namespace hg::config

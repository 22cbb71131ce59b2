#include "hg/prepositioning/prepositioning.h"

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"

namespace hg::prepositioning {
namespace {

constexpr double kTakenBack = 0.25;  // m/s or rad/s, of the gantry by the arm in front of a limit

}  // namespace

void check(const Config& config) {
  const auto require = [](bool ok, const char* rule) {
    if (!ok) throw SetupError(std::string("prepositioning: ") + rule);
  };
  require(config.n_p >= 0 && config.n_p <= kMaxGantry, "at most two gantry joints are possible");
  require(std::isfinite(config.k_ppu) && config.k_ppu > 0.0, "k_ppu must be positive");
  require(config.dq_max > 0.0, "dq_max must be positive");
  for (int i = 0; i < config.n_p; ++i) {
    require(!config.q_limits[static_cast<std::size_t>(i)].empty(), "limits must not be reversed");
  }
  limits::check(config.drive, "prepositioning");
}

Command step(const Config& config, const RobotState& robot, const VectorP& q_target,
             bool device_blocked, double dq_max, const Room& room) noexcept {
  const double fastest = std::min(config.dq_max, dq_max);
  Command command = {q_target, VectorP::Zero(config.n_p)};
  if (device_blocked) return command;
  for (int i = 0; i < config.n_p; ++i) {
    const Interval q_limits = config.q_limits[static_cast<std::size_t>(i)];
    command.q_target[i] = std::clamp(command.q_target[i], q_limits.lb, q_limits.ub);
    Interval bounds = limits::braking_velocity_bounds(q_limits, config.drive, robot.q_p[i]);
    if (room.up.size() > 0) {
      const Interval alone =
          limits::braking_velocity_bounds({-room.down[i], room.up[i]}, config.drive, 0.0);
      bounds.lb = std::max(bounds.lb, std::min(alone.lb, 0.0) - kTakenBack);
      bounds.ub = std::min(bounds.ub, std::max(alone.ub, 0.0) + kTakenBack);
    }
    const double dq = config.k_ppu * (command.q_target[i] - robot.q_p[i]);  // [HG] (27)
    command.dq[i] = std::clamp(std::clamp(dq, bounds.lb, bounds.ub), -fastest, fastest);
  }
  return command;
}

}  // namespace hg::prepositioning

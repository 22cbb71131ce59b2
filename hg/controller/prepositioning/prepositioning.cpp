#include "hg/controller/prepositioning/prepositioning.h"

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"

namespace hg::prepositioning {
namespace {

constexpr double kLead = 0.1;  // m/s or rad/s, of the law beside the rule
// s until the law may demand the full acceleration of the drives: it sees the effect late
double onset(const DriveModel& drive) noexcept { return std::max(60e-3, 15.0 * drive.dead_time); }

// gantry speed when a command sent now arrives
VectorP speed_then(const DriveModel& drive, const RobotState& robot) noexcept {
  return robot.dq_p + drive.dead_time * robot.ddq_p;
}

}  // namespace

Prepositioning::Prepositioning(const PrepositioningConfig& config, const DeviceModel& device)
    : config_(config),
      range_(device.gantry_range),
      drive_(device.drive),
      dt_(device.dt()),
      response_{.tau = drive_.dead_time + drive_.lag + dt_, .ddq_max = config.ddq_max} {
  const auto require = [](bool ok, const char* rule) {
    if (!ok) throw SetupError(std::string("prepositioning: ") + rule);
  };
  require(std::isfinite(config.k_ppu) && config.k_ppu > 0.0, "k_ppu must be positive");
  require(config.dq_max > 0.0, "dq_max must be positive");
  require(config.taken_back >= 0.0, "taken_back must not be negative");
  limits::check_drive_response(response_, "prepositioning");
}

GantryCommand Prepositioning::step(const RobotState& robot, const VectorP& q_target,
                                   bool device_blocked, double dq_max, const Room& room,
                                   const VectorP& away) const noexcept {
  const double fastest = std::min(config_.dq_max, dq_max);
  const auto n_p = static_cast<int>(range_.size());
  GantryCommand command = {q_target, VectorP::Zero(n_p), VectorP::Zero(n_p), VectorP::Zero(n_p)};
  for (int i = 0; i < n_p; ++i) {
    const Interval q_limits = range_[i];
    command.q_target[i] = std::clamp(command.q_target[i], q_limits.lb, q_limits.ub);
    Interval bounds = limits::braking_velocity_bounds(q_limits, response_, robot.q_p[i]);
    if (room.up.size() > 0) {
      const Interval alone =
          limits::braking_velocity_bounds({-room.down[i], room.up[i]}, response_, 0.0);
      bounds.lb = std::max(bounds.lb, std::min(alone.lb, 0.0) - config_.taken_back);
      bounds.ub = std::min(bounds.ub, std::max(alone.ub, 0.0) + config_.taken_back);
    }
    const double to_target = config_.k_ppu * (command.q_target[i] - robot.q_p[i]);  // [HG] (27)
    const double dq = away.size() > 0 ? away[i] : to_target;
    command.dq_min[i] = std::clamp(bounds.lb, -fastest, fastest);
    command.dq_max[i] = std::clamp(bounds.ub, -fastest, fastest);
    if (device_blocked) continue;
    command.dq[i] = std::clamp(dq, command.dq_min[i], command.dq_max[i]);
  }
  return command;
}

GantryTask Prepositioning::accelerations(const GantryCommand& command, const RobotState& robot,
                                         const VectorP& last) const noexcept {
  const VectorP dq = speed_then(drive_, robot);
  const VectorP& before = last.size() > 0 ? last : robot.ddq_p;
  const double change = drive_.ddq_max * dt_ / onset(drive_);
  GantryTask task = {dq, dq, dq, VectorP::Zero(dq.size())};
  for (Eigen::Index i = 0; i < dq.size(); ++i) {
    const auto of = [&](double dq_cmd) { return drive_acceleration(drive_, dq[i], dq_cmd); };
    const double aim = std::clamp(command.dq[i], command.dq_min[i], command.dq_max[i]);
    const double least = of(std::max(command.dq_min[i], aim - kLead));
    const double most = of(std::min(command.dq_max[i], aim + kLead));
    task.ddq_min[i] = std::clamp(before[i] - change, least, most);
    task.ddq_max[i] = std::clamp(before[i] + change, least, most);
    task.ddq[i] = of(aim);
  }
  return task;
}

VectorP Prepositioning::velocity_for(const VectorP& ddq, const GantryCommand& command,
                                     const RobotState& robot) const noexcept {
  const VectorP dq = speed_then(drive_, robot) + drive_.lag * ddq;
  return dq.cwiseMax(command.dq_min).cwiseMin(command.dq_max);
}

}  // namespace hg::prepositioning

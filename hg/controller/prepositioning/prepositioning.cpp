#include "hg/controller/prepositioning/prepositioning.h"

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"

namespace hg::prepositioning {
namespace {

// m/s or rad/s, gantry speed that the arm compensates in front of a limit
constexpr double kTakenBack = 0.25;
constexpr double kLead = 0.1;  // m/s or rad/s, of the law beside the rule
// s until the law may demand the full acceleration of the drives: it sees the effect late
double onset(const DriveModel& drive) noexcept { return std::max(60e-3, 15.0 * drive.dead_time); }

// gantry speed when a command sent now arrives
VectorP speed_then(const DriveModel& drive, const RobotState& robot) noexcept {
  return robot.dq_p + drive.dead_time * robot.ddq_p;
}

}  // namespace

void check_prepositioning(const PrepositioningConfig& config) {
  const auto require = [](bool ok, const char* rule) {
    if (!ok) throw SetupError(std::string("prepositioning: ") + rule);
  };
  require(config.n_p >= 0 && config.n_p <= kMaxGantry, "at most two gantry joints are possible");
  require(std::isfinite(config.k_ppu) && config.k_ppu > 0.0, "k_ppu must be positive");
  require(config.dq_max > 0.0, "dq_max must be positive");
  for (int i = 0; i < config.n_p; ++i) {
    require(!config.q_limits[index(i)].empty(), "limits must not be reversed");
  }
  limits::check_drive_response(config.drive, "prepositioning");
}

GantryCommand command_gantry(const PrepositioningConfig& config, const RobotState& robot,
                             const VectorP& q_target, bool device_blocked, double dq_max,
                             const Room& room, const VectorP& away) noexcept {
  const double fastest = std::min(config.dq_max, dq_max);
  GantryCommand command = {q_target, VectorP::Zero(config.n_p), VectorP::Zero(config.n_p),
                           VectorP::Zero(config.n_p)};
  for (int i = 0; i < config.n_p; ++i) {
    const Interval q_limits = config.q_limits[index(i)];
    command.q_target[i] = std::clamp(command.q_target[i], q_limits.lb, q_limits.ub);
    Interval bounds = limits::braking_velocity_bounds(q_limits, config.drive, robot.q_p[i]);
    if (room.up.size() > 0) {
      const Interval alone =
          limits::braking_velocity_bounds({-room.down[i], room.up[i]}, config.drive, 0.0);
      bounds.lb = std::max(bounds.lb, std::min(alone.lb, 0.0) - kTakenBack);
      bounds.ub = std::min(bounds.ub, std::max(alone.ub, 0.0) + kTakenBack);
    }
    const double to_target = config.k_ppu * (command.q_target[i] - robot.q_p[i]);  // [HG] (27)
    const double dq = away.size() > 0 ? away[i] : to_target;
    command.dq_min[i] = std::clamp(bounds.lb, -fastest, fastest);
    command.dq_max[i] = std::clamp(bounds.ub, -fastest, fastest);
    if (device_blocked) continue;
    command.dq[i] = std::clamp(dq, command.dq_min[i], command.dq_max[i]);
  }
  return command;
}

GantryTask accelerations(const GantryCommand& command, const DriveModel& drive,
                         const RobotState& robot, const VectorP& last, double dt) noexcept {
  const VectorP dq = speed_then(drive, robot);
  const VectorP& before = last.size() > 0 ? last : robot.ddq_p;
  const double change = drive.ddq_max * dt / onset(drive);
  GantryTask task = {dq, dq, dq, VectorP::Zero(dq.size())};
  for (Eigen::Index i = 0; i < dq.size(); ++i) {
    const auto of = [&](double dq_cmd) { return drive_acceleration(drive, dq[i], dq_cmd); };
    const double aim = std::clamp(command.dq[i], command.dq_min[i], command.dq_max[i]);
    const double least = of(std::max(command.dq_min[i], aim - kLead));
    const double most = of(std::min(command.dq_max[i], aim + kLead));
    task.ddq_min[i] = std::clamp(before[i] - change, least, most);
    task.ddq_max[i] = std::clamp(before[i] + change, least, most);
    task.ddq[i] = of(aim);
  }
  return task;
}

VectorP velocity_for(const VectorP& ddq, const GantryCommand& command, const DriveModel& drive,
                     const RobotState& robot) noexcept {
  const VectorP dq = speed_then(drive, robot) + drive.lag * ddq;
  return dq.cwiseMax(command.dq_min).cwiseMin(command.dq_max);
}

}  // namespace hg::prepositioning

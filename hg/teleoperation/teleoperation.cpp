#include "hg/teleoperation/teleoperation.h"

#include <algorithm>
#include <string>
#include <utility>

#include "hg/core/error.h"

namespace hg::teleoperation {
namespace {

const TeleoperationConfig& checked(const TeleoperationConfig& config,
                                   const model::ChainModel& twin) {
  const auto size = static_cast<int>(config.machine.x_start.size());
  const auto axes = static_cast<int>(config.limiter.axes.size());
  if (size != axes) {
    throw SetupError("remote: " + std::to_string(size) + " coordinates, but limits of " +
                     std::to_string(axes));
  }
  if (config.mapping == Mapping::kTool && size != 3) {
    throw SetupError("remote: a tool has three coordinates, got " + std::to_string(size));
  }
  if (config.mapping == Mapping::kJoints && (size != twin.nv() || twin.nq() != twin.nv())) {
    throw SetupError(
        "remote: one coordinate per joint of the twin is needed, without floating "
        "ones: " +
        std::to_string(twin.nv()) + ", got " + std::to_string(size));
  }
  return config;
}

}  // namespace

Teleoperation::Teleoperation(const TeleoperationConfig& config, const model::ChainModel& twin,
                             int end_effector, double dt, std::unique_ptr<RemoteSide> remote)
    : config_(checked(config, twin)),
      twin_(twin),
      end_effector_(end_effector),
      leader_(config.method, config.leader, dt),
      remote_(remote ? std::move(remote)
                     : std::make_unique<SimulatedRemote>(config.method, config.limiter,
                                                         config.machine, dt)),
      to_remote_(config.link, 0, dt),
      to_leader_(config.link, 1, dt) {
  f_hand_ = v_ = PortVector::Zero(config.machine.x_start.size());
}

// The twin in coordinates of the remote machine. Positions of a tool are summed up, so that a
// change of scale moves nothing.
void Teleoperation::find_port(const TwinNow& now) noexcept {
  twin_.update_kinematics(now.twin.q_a, now.twin.dq_a);
  const double scale = config_.motion_scale;
  if (config_.mapping == Mapping::kJoints) {
    x_ = scale * now.twin.q_a;
    v_ = scale * now.twin.dq_a;
    f_hand_ = twin_.jacobian(end_effector_).transpose() * now.w_H / config_.force_scale;
    return;
  }
  const Eigen::Vector3d p = twin_.pose(end_effector_).p;
  if (x_.size() == 0) {
    x_ = PortVector::Zero(3);
    p_before_ = p;
  }
  x_ += scale * (config_.R_R_B * (p - p_before_));
  p_before_ = p;
  v_ = scale * (config_.R_R_B * twin_.twist(end_effector_).head<3>());
  f_hand_ = config_.R_R_B * now.w_H.head<3>() / config_.force_scale;
}

bool Teleoperation::is_clutch_closed(const TwinNow& now) noexcept {
  if (!now.is_running) return false;
  if (began_s_ < 0.0) began_s_ = now.time_s;
  const double since = now.time_s - began_s_;
  return !now.is_clutch_open &&
         std::ranges::none_of(config_.clutch_open,
                              [&](const Interval& open) { return open.contains(since); });
}

void Teleoperation::move_remote(double now_s) noexcept {
  while (to_remote_.receive(now_s, arrived_at_remote_)) remote_->send(arrived_at_remote_, now_s);
  remote_->step(now_s);
  while (remote_->receive(remote_packet_)) to_leader_.send(remote_packet_, now_s);
}

void Teleoperation::push(TwinForce& force) const noexcept {
  if (config_.mapping == Mapping::kJoints) {
    force.tau = config_.force_scale * f_leader_;
  } else {
    force.w_E.head<3>() = config_.force_scale * (config_.R_R_B.transpose() * f_leader_);
  }
}

void Teleoperation::step(const TwinNow& now, TwinForce& force,
                         TeleoperationReport& report) noexcept {
  find_port(now);
  while (to_leader_.receive(now.time_s, arrived_at_leader_)) {
    leader_.receive(arrived_at_leader_, now.time_s);
    meter_.receive(arrived_at_leader_.sequence, arrived_at_leader_.sent_s,
                   arrived_at_leader_.answered_s, now.time_s);
  }
  meter_.step(now.time_s);
  f_leader_ = leader_.step(
      now.time_s, {.x = x_, .v = v_, .f_hand = f_hand_, .is_clutch_closed = is_clutch_closed(now)},
      leader_packet_);
  to_remote_.send(leader_packet_, now.time_s);
  move_remote(now.time_s);
  push(force);

  const RemotePacket& arrived = leader_.arrived();
  report = {.link = leader_.link(),
            .cause = leader_.cause(),
            .age = arrived.sequence > 0 ? now.time_s - arrived.sent_s : 0.0,
            .x_leader = leader_.x(),
            .x_remote = arrived.x,
            .f_leader = f_leader_,
            .f_remote = arrived.f,
            .energy_leader = leader_.energy().net(),
            .energy_remote = arrived.energy_net,
            .dissipated = leader_.dissipated() + arrived.dissipated,
            .round_trip = meter_.round_trip(),
            .jitter = meter_.jitter(),
            .loss = meter_.loss()};
  if (const MachineState* truth = remote_->truth()) {
    report.x_true = truth->x;
    report.f_true = truth->f;
  }
}

}  // namespace hg::teleoperation

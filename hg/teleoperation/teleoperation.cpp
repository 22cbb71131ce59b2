#include "hg/teleoperation/teleoperation.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hg/core/error.h"
#include "hg/signals/twin_parameter.h"

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
  if (config.mapping != Mapping::kJoints && !config.leader.ranges.empty() &&
      config.leader.ranges.size() != config.limiter.axes.size()) {
    throw SetupError("remote: the leader needs a range for each coordinate of the tool");
  }
  if (config.mapping == Mapping::kTool && size != 3) {
    throw SetupError("remote: a tool has three coordinates, got " + std::to_string(size));
  }
  if (config.mapping == Mapping::kPose && size != 6) {
    throw SetupError("remote: a pose has six coordinates, got " + std::to_string(size));
  }
  if (config.mapping == Mapping::kJoints && (size != twin.nv() || twin.nq() != twin.nv())) {
    throw SetupError(
        "remote: one coordinate per joint of the twin is needed, without floating "
        "ones: " +
        std::to_string(twin.nv()) + ", got " + std::to_string(size));
  }
  return config;
}

void approach(double wanted, double share, double& value) noexcept {
  constexpr double kThere = 1e-3;  // of what is wanted
  value += share * (wanted - value);
  if (std::abs(wanted - value) < kThere * wanted) value = wanted;
}

}  // namespace

Teleoperation::Teleoperation(const TeleoperationConfig& config, const model::ChainModel& twin,
                             int end_effector, double dt, std::unique_ptr<RemoteSide> remote)
    : config_(checked(config, twin)),
      twin_(twin),
      end_effector_(end_effector),
      dt_(dt),
      motion_scale_(Eigen::Vector3d::Constant(config.motion_scale)),
      force_scale_(Eigen::Vector3d::Constant(config.force_scale)),
      wanted_motion_(motion_scale_),
      wanted_force_(force_scale_),
      turn_(config.lever),
      leader_(config.method, config.leader, dt),
      remote_(remote ? std::move(remote)
                     : std::make_unique<SimulatedRemote>(config.method, config.limiter,
                                                         config.machine, dt)),
      to_remote_(config.link, 0, dt),
      to_leader_(config.link, 1, dt) {
  f_hand_ = v_ = PortVector::Zero(config.machine.x_start.size());
}

// Values that are felt change slowly; positions of a tool are sums, so that nothing jumps.
void Teleoperation::approach_scales(const ParameterChange& change) noexcept {
  constexpr double kTime = 0.3;  // s
  const bool is_motion = change.parameter == Parameter::kMotionScale;
  if (is_motion || change.parameter == Parameter::kForceScale) {
    const bool is_axis = change.index >= 0 && change.index < 3;
    const bool is_allowed = is_axis && allows(facts_of(change.parameter), change.value);
    if (is_allowed) (is_motion ? wanted_motion_ : wanted_force_)[change.index] = change.value;
  }
  const double share = std::min(1.0, dt_ / kTime);
  for (int i = 0; i < 3; ++i) {
    approach(wanted_motion_[i], share, motion_scale_[i]);
    approach(wanted_force_[i], share, force_scale_[i]);
  }
}

// The twin in coordinates of the remote machine.
void Teleoperation::find_port(const TwinNow& now) noexcept {
  twin_.update_kinematics(now.twin.q_a, now.twin.dq_a);
  if (config_.mapping == Mapping::kJoints) {
    x_ = config_.motion_scale * now.twin.q_a;
    v_ = config_.motion_scale * now.twin.dq_a;
    f_hand_ = twin_.jacobian(end_effector_).transpose() * now.w_H / config_.force_scale;
    return;
  }
  approach_scales(now.change);
  find_tool(now.w_H);
  if (config_.mapping == Mapping::kPose) find_turn(now.w_H);
}

void Teleoperation::find_tool(const Vector6& w_H) noexcept {
  const Eigen::Vector3d p = twin_.pose(end_effector_).p;
  if (x_.size() == 0) {
    x_ = PortVector::Zero(config_.machine.x_start.size());
    p_before_ = p;
  }
  x_.head<3>() += motion_scale_.cwiseProduct(config_.R_R_B * (p - p_before_));
  p_before_ = p;
  v_.head<3>() = motion_scale_.cwiseProduct(config_.R_R_B * twin_.twist(end_effector_).head<3>());
  f_hand_.head<3>() = (config_.R_R_B * w_H.head<3>()).cwiseQuotient(force_scale_);
}

// While both are not coupled, the turn is that of the remote tool.
void Teleoperation::find_turn(const Vector6& w_H) noexcept {
  const Eigen::Matrix3d& R_R_B = config_.R_R_B;
  const Eigen::Matrix3d R = R_R_B * twin_.pose(end_effector_).R * R_R_B.transpose();
  const PortVector& x_target = leader_.arrived().x_target;
  if (leader_.link() != RemoteLink::kEngaged) {
    turn_.begin(
        R, x_target.size() == 6 ? Eigen::Vector3d(x_target.tail<3>()) : Eigen::Vector3d::Zero());
  }
  turn_.follow(R);
  x_.tail<3>() = turn_.x();
  v_.tail<3>() = turn_.speed(R_R_B * twin_.twist(end_effector_).tail<3>());
  f_hand_.tail<3>() = turn_.force(R_R_B * w_H.tail<3>()) / config_.torque_scale;
}

// Such that the hand feels the same with every scale. Ends of joints are those of the twin.
PortVector Teleoperation::stiffness_of_ends() const noexcept {
  constexpr double kStiffness = 5e3;  // N/m, on the leader
  constexpr double kAngular = 50.0;   // Nm/rad
  if (config_.mapping == Mapping::kJoints) return {};
  PortVector stiffness = PortVector::Constant(
      x_.size(), kAngular / (config_.torque_scale * config_.lever * config_.lever));
  stiffness.head<3>() = kStiffness * motion_scale_.cwiseProduct(force_scale_).cwiseInverse();
  return stiffness;
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
    return;
  }
  const auto R_B_R = config_.R_R_B.transpose();
  force.w_E.head<3>() = R_B_R * force_scale_.cwiseProduct(f_leader_.head<3>());
  if (config_.mapping == Mapping::kPose) {
    force.w_E.tail<3>() =
        config_.torque_scale * (R_B_R * turn_.torque(Eigen::Vector3d(f_leader_.tail<3>())));
  }
}

void Teleoperation::step(const TwinNow& now, TwinForce& force,
                         TeleoperationReport& report) noexcept {
  while (to_leader_.receive(now.time_s, arrived_at_leader_)) {
    leader_.receive(arrived_at_leader_, now.time_s);
    meter_.receive(arrived_at_leader_.sequence, arrived_at_leader_.sent_s,
                   arrived_at_leader_.answered_s, now.time_s);
  }
  meter_.step(now.time_s);
  find_port(now);
  f_leader_ = leader_.step(now.time_s,
                           {.x = x_,
                            .v = v_,
                            .f_hand = f_hand_,
                            .is_clutch_closed = is_clutch_closed(now),
                            .end_stiffness = stiffness_of_ends()},
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
            .loss = meter_.loss(),
            .motion_scale = motion_scale_,
            .force_scale = force_scale_};
  if (const MachineState* truth = remote_->truth()) {
    report.x_true = truth->x;
    report.f_true = truth->f;
  }
}

}  // namespace hg::teleoperation

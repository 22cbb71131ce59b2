#include "hg/teleoperation/leader_half.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/first_not_finite.h"

namespace hg::teleoperation {

void check_leader(const LeaderConfig& config) {
  const auto require = [](bool ok, const char* rule, double value) {
    if (!ok) throw SetupError(std::string("leader: ") + rule + ", got " + std::to_string(value));
  };
  require(config.silence > 0.0, "silence must be positive", config.silence);
  require(config.fade > 0.0, "fade must be positive", config.fade);
  require(config.force_max > 0.0, "force_max must be positive", config.force_max);
  require(config.surplus > 0.0, "surplus must be positive", config.surplus);
  require(config.power >= 0.0, "power must not be negative", config.power);
  require(config.snapshot > 0.0, "snapshot must be positive", config.snapshot);
}

LeaderHalf::LeaderHalf(std::unique_ptr<LeaderMethod> method, const LeaderConfig& config, double dt)
    : config_((check_leader(config), config)), dt_(dt), method_(std::move(method)) {}

void LeaderHalf::receive(const RemotePacket& packet, double now_s) noexcept {
  if (packet.sequence <= arrived_.sequence) return;
  const bool is_first = arrived_.x.size() == 0;
  if (!is_first && !(packet.sent_s > arrived_.sent_s)) return;
  const Eigen::Index size = packet.x.size();
  const bool is_complete = size > 0 && packet.v.size() == size && packet.f.size() == size &&
                           packet.x_target.size() == size && packet.reflected.size() == size &&
                           packet.wave.size() == size && packet.energy.size() == size &&
                           (is_first || size == arrived_.x.size());
  const ContactModel& model = packet.model;
  const bool has_model = model.normal.size() == size || model.stiffness == 0.0;
  const int bad = first_not_finite(packet.x, packet.v, packet.x_target, packet.f, packet.reflected,
                                   packet.wave, packet.energy, model.normal);
  const bool is_finite =
      bad < 0 && std::isfinite(model.offset + model.stiffness + packet.energy_net);
  if (!is_complete || !has_model || !is_finite) {
    arrived_.sequence = packet.sequence;
    if (link_ == RemoteLink::kEngaged) {
      link_ = RemoteLink::kLost;
      cause_ = RemoteCause::kNotFinite;
    }
    return;
  }
  is_changed_ = is_changed_ || is_first || packet.x != arrived_.x || packet.v != arrived_.v ||
                packet.f != arrived_.f || packet.x_target != arrived_.x_target;
  arrived_ = packet;
  arrived_s_ = now_s;
  is_new_ = true;
}

// The newest packet answers this engagement.
bool LeaderHalf::is_confirmed() const noexcept { return arrived_.engagement == engagements_; }

// Why the force must end although packets arrive.
RemoteCause LeaderHalf::distrust() const noexcept {
  if (is_confirmed() && holds(arrived_.cause)) return arrived_.cause;
  // it has confirmed this engagement and left it
  if (is_started_ && !is_confirmed())
    return holds(arrived_.cause) ? arrived_.cause : RemoteCause::kReplayed;
  if (surplus_ > config_.surplus) return RemoteCause::kActive;
  // it answers what was sent after the leader had moved, and has not changed
  const bool follows = is_started_ && arrived_.cause == RemoteCause::kNone;
  if (follows && arrived_.answered_s > led_s_ + config_.silence) return RemoteCause::kFrozen;
  return RemoteCause::kNone;
}

// How much energy comes, and when the leader had moved although nothing in the packets has.
void LeaderHalf::watch(double now_s) noexcept {
  constexpr double kLed = 0.02;  // m or rad; who follows has moved by then
  const double net = energy_.net();
  surplus_ = std::max(0.0, surplus_ - (net - net_before_) - config_.power * dt_);
  net_before_ = net;
  if (is_changed_) {
    x_unchanged_ = x_;
    led_s_ = kInfinity;
    is_changed_ = false;
  } else if (led_s_ == kInfinity && (x_ - x_unchanged_).lpNorm<Eigen::Infinity>() > kLed) {
    led_s_ = now_s;
  }
}

void LeaderHalf::engage(const LeaderInput& input) noexcept {
  const PortVector offset = arrived_.x_target - input.x;
  if (offset.lpNorm<Eigen::Infinity>() > config_.snapshot) return;
  offset_ = offset;
  ++engagements_;
  link_ = RemoteLink::kEngaged;
  cause_ = RemoteCause::kNone;
  was_open_ = is_started_ = false;
  method_->start(input.x.size());
  energy_.start(input.x.size());
  force_ = applied_ = PortVector::Zero(input.x.size());
  x_before_.resize(0);
  is_changed_ = true;
  surplus_ = net_before_ = 0.0;
  share_ = 0.0;
}

// The clutch, and whether the link is there.
void LeaderHalf::operate(double now_s, const LeaderInput& input) noexcept {
  const bool is_alive = now_s - arrived_s_ <= config_.silence;
  if (!input.is_clutch_closed) was_open_ = true;
  switch (link_) {
    case RemoteLink::kNone:
    case RemoteLink::kWaiting:
      if (is_alive) link_ = RemoteLink::kReleased;
      break;
    case RemoteLink::kEngaged:
      if (!input.is_clutch_closed) {
        link_ = RemoteLink::kReleased;
        cause_ = RemoteCause::kReleased;
      } else if (!is_alive) {
        link_ = RemoteLink::kLost;
        cause_ = RemoteCause::kSilent;
      } else if (const RemoteCause cause = distrust(); cause != RemoteCause::kNone) {
        link_ = RemoteLink::kLost;
        cause_ = cause;
      } else {
        cause_ = is_confirmed() ? arrived_.cause : RemoteCause::kNone;
      }
      break;
    case RemoteLink::kReleased:
    case RemoteLink::kLost:
      break;
  }
  const bool may_engage = link_ == RemoteLink::kReleased || link_ == RemoteLink::kLost;
  if (may_engage && is_alive && was_open_ && input.is_clutch_closed && share_ == 0.0) {
    engage(input);
  }
}

// The ends of the remote machine's range are known here, and felt at once, as damped springs.
PortVector LeaderHalf::force_of_ends(const LeaderInput& input) const noexcept {
  constexpr double kDampedFor = 0.024;  // s, damping over stiffness: 0.35 of critical with 6 kg
  constexpr double kRamp = 1e-3;        // of a depth, in which damping grows
  PortVector force = PortVector::Zero(x_.size());
  if (config_.ranges.empty() || input.end_stiffness.size() != x_.size()) return force;
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const Interval& range = config_.ranges[static_cast<std::size_t>(i)];
    const double out = x_[i] > range.ub ? x_[i] - range.ub : std::min(0.0, x_[i] - range.lb);
    const double depth = std::abs(out);
    if (depth == 0.0) continue;
    const double sign = out > 0.0 ? 1.0 : -1.0;
    const double damped = kDampedFor * std::min(1.0, depth / kRamp) * sign * input.v[i];
    force[i] = -sign * input.end_stiffness[i] * std::max(0.0, depth + damped);
  }
  return force;
}

PortVector LeaderHalf::step(double now_s, const LeaderInput& input, LeaderPacket& packet) noexcept {
  const Eigen::Index size = input.x.size();
  if (offset_.size() != size) {
    offset_ = force_ = applied_ = PortVector::Zero(size);
    energy_.start(size);
  }
  operate(now_s, input);
  x_ = input.x + offset_;
  if (x_before_.size() == size) energy_.add(applied_, x_ - x_before_);
  x_before_ = x_;
  watch(now_s);

  const bool is_engaged = link_ == RemoteLink::kEngaged;
  packet = {.sequence = ++sequence_,
            .engagement = is_engaged ? engagements_ : 0,
            .sent_s = now_s,
            .x = x_,
            .v = input.v,
            .f = PortVector::Zero(size),
            .wave = PortVector::Zero(size),
            .energy = PortVector::Zero(size)};
  if (is_engaged && is_confirmed() && arrived_.x.size() == size) is_started_ = true;
  if (is_engaged && (is_started_ || arrived_.x.size() == size)) {
    RemotePacket quiet = arrived_;
    if (!is_started_) {  // what arrives is of an earlier engagement
      quiet.reflected.setZero();
      quiet.wave.setZero();
      quiet.energy.setZero();
      quiet.model = {};
      quiet.model.normal = PortVector::Zero(size);
    }
    force_ = method_->step({.x = x_, .v = input.v, .f_hand = input.f_hand, .energy = energy_},
                           quiet, is_new_ && is_started_, packet);
    force_ += force_of_ends(input);
    if (!is_started_) force_.setZero();
    is_new_ = false;
  }
  const double step = dt_ / config_.fade;
  share_ = std::clamp(share_ + (is_engaged && is_started_ ? step : -step), 0.0, 1.0);
  applied_ = share_ * force_;
  const double norm = applied_.norm();
  if (norm > config_.force_max) applied_ *= config_.force_max / norm;
  return applied_;
}

}  // namespace hg::teleoperation

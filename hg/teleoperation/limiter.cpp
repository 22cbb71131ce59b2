#include "hg/teleoperation/limiter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/core/error.h"
#include "hg/core/first_not_finite.h"

namespace hg::teleoperation {

void check_limiter(const LimiterConfig& config) {
  const auto require = [](bool ok, const std::string& rule) {
    if (!ok) throw SetupError("remote: " + rule);
  };
  const auto size = static_cast<int>(config.axes.size());
  require(size >= 1 && size <= kMaxPort,
          "a machine has 1 to 7 coordinates, got " + std::to_string(size));
  require(config.silence > 0.0, "silence must be positive");
  require(config.jump_speed > 0.0, "jump_speed must be positive");
  for (const AxisLimits& axis : config.axes) {
    require(axis.v_max > 0.0 && axis.a_max > 0.0 && axis.f_max > 0.0,
            "speed, acceleration and force must be positive");
    require(axis.range.lb < axis.range.ub, "a range must not be empty");
  }
}

bool PacketGate::has_jumped(const LeaderPacket& packet) const noexcept {
  constexpr double kRounding = 5e-3;  // m or rad
  const double elapsed = packet.sent_s - newest_.sent_s;
  const double way = (packet.x - newest_.x).lpNorm<Eigen::Infinity>();
  return way > config_.jump_speed * elapsed + kRounding;
}

void PacketGate::forget() noexcept {
  newest_ = {};
  used_s_ = 0.0;
  repeated_ = frozen_ = 0;
  cause_ = RemoteCause::kReleased;
}

bool PacketGate::take(const LeaderPacket& packet, double now_s) noexcept {
  const auto size = static_cast<Eigen::Index>(config_.axes.size());
  if (packet.engagement < newest_.engagement && packet.engagement != 0) {
    ++repeated_;
    return false;
  }
  if (packet.sequence <= newest_.sequence) {
    ++repeated_;
    return false;
  }
  if (!(packet.sent_s > newest_.sent_s) && newest_.sequence > 0) {
    ++frozen_;
    return false;
  }
  const bool is_complete = packet.x.size() == size && packet.v.size() == size;
  const bool is_first = packet.engagement != newest_.engagement;
  if (packet.engagement == 0) {
    cause_ = RemoteCause::kReleased;
  } else if (is_first) {
    cause_ = RemoteCause::kNone;
  }
  if (packet.engagement != 0 && !holds(cause_)) {
    const int bad = first_not_finite(packet.x, packet.v, packet.f, packet.wave, packet.energy);
    if (!is_complete || bad >= 0 || !std::isfinite(packet.sent_s)) {
      cause_ = RemoteCause::kNotFinite;
    } else if (!is_first && has_jumped(packet)) {
      cause_ = RemoteCause::kJump;
    }
  }
  if (holds(cause_)) {  // the numbers count, its content does not
    newest_.sequence = packet.sequence;
    newest_.engagement = packet.engagement;
    return false;
  }
  newest_ = packet;
  used_s_ = now_s;
  repeated_ = frozen_ = 0;
  return true;
}

RemoteCause PacketGate::check(double now_s) noexcept {
  if (cause_ == RemoteCause::kNone && now_s - used_s_ > config_.silence) {
    cause_ = frozen_ > 0     ? RemoteCause::kFrozen
             : repeated_ > 0 ? RemoteCause::kReplayed
                             : RemoteCause::kSilent;
  }
  return cause_;
}

namespace {

constexpr double kGently = 0.25;  // of a_max, in front of an end: the machine overshoots its target
constexpr double kBehind = 2e-3;  // m or rad; jitter of the link alone stays below

// Speed from which `way` is enough to stop, one period at that speed and less in each of the next:
// v dt / 2 + v^2 / (2 a).
double stopping_speed(double way, double a_max, double dt) noexcept {
  if (way == kInfinity) return kInfinity;
  return a_max * (std::sqrt(0.25 * dt * dt + 2.0 * way / a_max) - 0.5 * dt);
}

}  // namespace

// A velocity beside that of the target, and an added force, push the machine off its target: no
// further than 0.25 m/s against its damper, and never out of its range.
void TargetLimiter::limit_push(const AxisLimits& axis, double x, double speed, double& v,
                               double& f) const noexcept {
  constexpr double kBeside = 0.25;  // m/s or rad/s
  v = std::clamp(v, speed - kBeside, speed + kBeside);
  const double out = machine_.stiffness * std::max(0.0, axis.range.ub - x);
  const double in = machine_.stiffness * std::max(0.0, x - axis.range.lb);
  const double pushed = std::clamp(machine_.damping * (v - speed), -in, out);
  if (machine_.damping > 0.0) v = speed + pushed / machine_.damping;
  f = std::clamp(f, std::min(0.0, -in - pushed), std::max(0.0, out - pushed));
}

RemoteTarget TargetLimiter::step(const RemoteTarget& wanted, const PortVector& x,
                                 const PortVector& v, RemoteCause& cause) const noexcept {
  RemoteTarget target = {x, v, wanted.f};
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const AxisLimits& axis = config_.axes[i];
    const double goal = std::clamp(wanted.x[i], axis.range.lb, axis.range.ub);
    if (goal != wanted.x[i]) cause = RemoteCause::kRange;
    double speed = (goal - x[i]) / dt_;
    // slow enough to stop at the goal, relative to the goal; ends of the range do not move
    const double moving = goal == wanted.x[i] ? std::abs(wanted.v[i]) : 0.0;
    const double to_end = speed > 0.0 ? axis.range.ub - x[i] : x[i] - axis.range.lb;
    const double most = std::min(stopping_speed(std::abs(goal - x[i]), axis.a_max, dt_) + moving,
                                 stopping_speed(std::max(0.0, to_end), kGently * axis.a_max, dt_));
    speed = std::clamp(speed, -most, most);
    const bool is_fast = std::abs(speed) > axis.v_max;
    if (is_fast) speed = std::clamp(speed, -axis.v_max, axis.v_max);
    speed = std::clamp(speed, v[i] - axis.a_max * dt_, v[i] + axis.a_max * dt_);
    target.x[i] = x[i] + speed * dt_;
    // near the goal the machine's damper works against what is wanted, else against the way there
    const bool is_behind = std::abs(goal - target.x[i]) > kBehind;
    target.v[i] = is_behind ? speed : std::clamp(wanted.v[i], -axis.v_max, axis.v_max);
    if (is_behind && cause == RemoteCause::kNone) {
      cause = is_fast ? RemoteCause::kSpeed : RemoteCause::kAcceleration;
    }
    if (std::abs(wanted.f[i]) > axis.f_max) {
      target.f[i] = std::clamp(wanted.f[i], -axis.f_max, axis.f_max);
      cause = RemoteCause::kForce;
    }
    limit_push(axis, target.x[i], speed, target.v[i], target.f[i]);
  }
  return target;
}

}  // namespace hg::teleoperation

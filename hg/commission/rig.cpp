#include "hg/commission/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hg::commission {
namespace {

constexpr double kHold = 1.0;              // s for which the drives hold before anything is led
constexpr double kSettle = 0.3;            // s after a stroke
constexpr double kFade = 0.15;             // s in which a stroke stops when the key is let go of
constexpr double kPatience = 20.0;         // s without a key until the drives go off
constexpr double kAstray = 0.015;          // rad, largest distance of a joint from its reference
constexpr double kSlideAstray = 0.004;     // m
constexpr std::uint64_t kMostMissing = 4;  // samples in a row, with drives on
constexpr double kMiddle = 0.15;           // share of a stroke around its middle, where it is fast
constexpr double kBias = 0.3;              // s in which the gyroscope is read at rest

// Minimum-jerk motion from 0 to 1 at the share t of its duration; derivatives by t.
struct Ramp {
  double position, velocity, acceleration;
};
Ramp ramp(double t) {
  const double s = 1.0 - t;
  return {t * t * t * (10.0 + t * (-15.0 + 6.0 * t)), 30.0 * t * t * s * s,
          60.0 * t * s * (1.0 - 2.0 * t)};
}

}  // namespace

Rig::Rig(const config::DeviceConfig& config, device::Device& machine, Crew& crew)
    : config_(config),
      machine_(machine),
      crew_(crew),
      estimation_(config.estimation, config.model),
      control_(config.control, config.model),
      control_state_(control_.start()),
      sanitiser_(config.sanitiser, config.model, config.prepositioning.dq_max),
      chain_(config.model.chain),
      required_{.n_p = config.model.n_p,
                .n_m = config.model.n_m,
                .has_torque_loop = config.control.method != tracking::Method::kDrives,
                .has_imu = config.estimation.wrench.has_imu},
      dq_p_(VectorP::Zero(config.model.n_p)) {
  next_ = {VectorM::Zero(config.model.n_m), VectorM::Zero(config.model.n_m),
           VectorM::Zero(config.model.n_m)};
}

// One period. `next_` is the reference a period later, `dq_p_` the command of the gantry.
void Rig::exchange(bool is_on) {
  machine_.read(sensors_);
  const auto end = [&](const std::string& why) {
    command_.sequence = sensors_.sequence;
    disable(command_);
    machine_.write(command_);
    was_on_ = false;
    throw Ended{why};
  };
  if (sensors_.driver_fault != FaultCode::kNone) end(std::string(to_string(sensors_.driver_fault)));
  if (const Fault fault = check_values(sensors_, required_); fault.code != FaultCode::kNone) {
    end(std::string(to_string(fault.code)));
  }
  if (crew_.wants_to_end()) end("interrupted");
  if (is_on && sensors_.sequence > last_sequence_ + kMostMissing) {
    end(fmt::format("{} samples in a row are missing", sensors_.sequence - last_sequence_ - 1));
  }
  last_sequence_ = sensors_.sequence;
  const SafetyInputs& safety = sensors_.safety;
  if (is_on && (safety.emergency_stop || !safety.operator_enable || safety.has_disagreement)) {
    end(safety.emergency_stop     ? "the emergency stop was pressed"
        : safety.has_disagreement ? "two channels of a safety input disagree"
                                  : "the enabling switch was let go of");
  }
  robot_ = estimation_.step(sensors_, dq_p_, next_.ddq_m, estimation_state_);
  control_.listen(sensors_, was_on_, control_state_);
  if (is_on && was_on_) {
    const Fault late = control_.check_latency(sensors_, control_state_);
    if (late.code != FaultCode::kNone) end(std::string(to_string(late.code)));
  }
  command_.sequence = sensors_.sequence;
  const VectorM q_before = command_.q_m, tau_before = command_.tau_m;
  command_.enable = is_on;
  command_.dq_p = dq_p_;
  if (is_on) {
    TrackingReport report;
    control_.step(now_, next_, robot_, control_state_, command_, report);
  } else {
    next_ = {robot_.q_m, VectorM::Zero(config_.model.n_m), VectorM::Zero(config_.model.n_m)};
    control_.rest(next_, control_state_, command_);
    command_.dq_p.setZero();
    q_p_reference_ = robot_.q_p;
  }
  crew_.act(handle(), command_);
  const safety::Sanitised sanitised = sanitiser_.step(
      {.robot = robot_, .was_on = was_on_, .q_before = q_before, .tau_before = tau_before},
      command_);
  if (sanitised.fault.code != FaultCode::kNone) end(std::string(to_string(sanitised.fault.code)));
  machine_.write(command_);
  was_on_ = command_.enable;
  now_ = next_;
}

Pose Rig::handle() {
  if (const Truth* truth = machine_.truth(); truth != nullptr) return truth->T_B_H;
  chain_.update_poses(positions());
  return chain_.pose(config_.model.handle);
}

void Rig::rest(double duration_s, const Look& look) {
  dq_p_.setZero();
  const auto periods = static_cast<int>(std::lround(duration_s / dt()));
  for (int k = 0; k < periods; ++k) {
    exchange(false);
    if (look) look(sensors_, robot_);
  }
}

// First joint that has left its reference, `joint` before all others; -1: none.
int Rig::astray(int joint) const {
  const VectorPM away = (positions() - reference()).cwiseAbs();
  const auto is_away = [&](int i) {
    return away[i] > (config_.model.chain.joints()[i].is_slide() ? kSlideAstray : kAstray);
  };
  if (joint >= 0 && is_away(joint)) return joint;
  for (int i = 0; i < away.size(); ++i) {
    if (is_away(i)) return i;
  }
  return -1;
}

// A period with drives on. They go off where the key has not been held for long.
void Rig::exchange_on() {
  exchange(true);
  without_key_s_ = crew_.holds_key() ? 0.0 : without_key_s_ + dt();
  if (without_key_s_ <= kPatience) return;
  power_off();
  throw Ended{"the key was let go of"};
}

bool Rig::power_on(VectorPM& moved) {
  // the latency of a torque loop is learnt while the drives are off
  for (int k = 0; !control_.is_latency_known(control_state_); ++k) {
    if (k > 10 * tracking::kAnswersNeeded) throw Ended{"the machine answers no command"};
    exchange(false);
  }
  if (!control_.is_stable(control_state_)) {
    throw Ended{
        fmt::format("commands take {:.1f} ms to reach the drives, too long for the torque "
                    "loop of the device file",
                    1e3 * control_state_.latency * dt())};
  }
  exchange(false);
  const VectorPM from = positions();
  without_key_s_ = 0.0;
  const auto periods = static_cast<int>(std::lround(kHold / dt()));
  for (int k = 0; k < periods; ++k) {
    exchange_on();
    moved = positions() - from;
    if (!crew_.holds_key()) {
      power_off();
      throw Ended{"the key was let go of while the drives came on"};
    }
    if (astray(-1) < 0) continue;
    power_off();
    return false;
  }
  return true;
}

void Rig::power_off() {
  dq_p_.setZero();
  exchange(false);
}

void Rig::hold(double duration_s) {
  dq_p_.setZero();
  const auto periods = static_cast<int>(std::lround(duration_s / dt()));
  for (int k = 0; k < periods; ++k) {
    exchange_on();
    const int joint = astray(-1);
    if (joint < 0) continue;
    power_off();
    throw Ended{name_of(config_.model, joint) + " left its place while all joints were held"};
  }
}

FaultCode Rig::fall_silent(double duration_s) {
  const auto periods = static_cast<int>(std::lround(duration_s / dt()));
  for (int k = 0; k < periods; ++k) {
    machine_.read(sensors_);
    if (sensors_.driver_fault != FaultCode::kNone) {
      was_on_ = false;
      return sensors_.driver_fault;
    }
    robot_ = estimation_.step(sensors_, dq_p_, next_.ddq_m, estimation_state_);
    const SafetyInputs& safety = sensors_.safety;
    if (astray(-1) >= 0 || crew_.wants_to_end() || safety.emergency_stop ||
        !safety.operator_enable) {
      break;
    }
  }
  command_.sequence = sensors_.sequence;
  disable(command_);
  machine_.write(command_);
  was_on_ = false;
  return FaultCode::kNone;
}

Stroke Rig::lead(int joint, double way) {
  const int n_p = config_.model.n_p;
  const ReferenceState start = next_;
  Stroke stroke = {.joint = joint, .by_speed = VectorM::Zero(config_.model.n_m)};
  stroke.has_gyroscope = required_.has_imu;
  // what gyroscope and speeds read at rest
  Eigen::Vector3d turn_bias = Eigen::Vector3d::Zero();
  VectorM speed_bias = VectorM::Zero(config_.model.n_m);
  const auto still = static_cast<int>(std::lround(kBias / dt()));
  for (int k = 0; k < still; ++k) {
    hold(dt());
    turn_bias += sensors_.omega_S / still;
    speed_bias += sensors_.dq_m / still;
  }
  const VectorPM from = positions();
  stroke.lowest = stroke.highest = VectorPM::Zero(from.size());
  const VectorM motors_from = robot_.theta_m;
  double t = 0.0, pace = 0.0, lag = 0.0, torque = 0.0;
  int in_the_middle = 0;
  while (t < kDuration + kSettle) {
    pace = std::clamp(pace + (crew_.holds_key() ? dt() : -dt()) / kFade, 0.0, 1.0);
    const Ramp at = ramp(std::min(t / kDuration, 1.0));
    const double scale = pace / kDuration;
    t += pace * dt();
    const Ramp then = ramp(std::min(t / kDuration, 1.0));
    if (joint < n_p) {
      dq_p_.setZero();
      dq_p_[joint] = way * (then.position - at.position) / dt();
      q_p_reference_[joint] += way * (then.position - at.position);
    } else {
      const int i = joint - n_p;
      next_ = start;
      next_.q_m[i] += way * then.position;
      next_.dq_m[i] = way * then.velocity * scale;
      next_.ddq_m[i] = way * then.acceleration * scale * scale;
    }
    exchange_on();
    stroke.way = way * at.position;
    stroke.moved = positions() - from;
    stroke.lowest = stroke.lowest.cwiseMin(stroke.moved);
    stroke.highest = stroke.highest.cwiseMax(stroke.moved);
    if (robot_.theta_m.size() > 0) stroke.motors = robot_.theta_m - motors_from;
    if (pace > 0.0) {
      stroke.by_speed += dt() * (sensors_.dq_m - speed_bias);
      stroke.turned += dt() * (sensors_.omega_S - turn_bias);
      lag += dt() * (stroke.way - stroke.moved[joint]);
    }
    if (joint >= n_p && command_.tau_m.size() > 0 && std::abs(t / kDuration - 0.5) < kMiddle) {
      torque += command_.tau_m[joint - n_p];
      ++in_the_middle;
    }
    if (astray(joint) < 0) continue;
    power_off();
    stroke.is_cut = true;
    return stroke;
  }
  if (in_the_middle > 0) stroke.torque = torque / in_the_middle;
  stroke.late = lag / way;
  return stroke;
}

}  // namespace hg::commission

#include "hg/commissioning/bring_up/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hg::bring_up {
namespace {

constexpr double kHold = 1.0;          // s for which the drives hold before anything is led
constexpr double kSettle = 0.3;        // s after a stroke
constexpr double kFade = 0.15;         // s in which a stroke stops when the key is let go of
constexpr double kPatience = 20.0;     // s without a key until the drives go off
constexpr double kAstray = 0.03;       // rad, largest distance of a led joint from its reference
constexpr double kSlideAstray = 0.01;  // m
constexpr double kStray = 0.015;       // rad, largest motion of any other joint
constexpr double kSlideStray = 0.004;  // m
constexpr double kMiddle = 0.15;       // share of a stroke around its middle, where it is fast
constexpr double kBias = 0.3;          // s in which the gyroscope is read at rest

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
  const SafetyInputs& safety = sensors_.safety;
  if (is_on && (safety.emergency_stop || !safety.operator_enable || safety.has_disagreement)) {
    end(safety.emergency_stop     ? "the emergency stop was pressed"
        : safety.has_disagreement ? "two channels of a safety input disagree"
                                  : "the enabling switch was let go of");
  }
  robot_ = estimation_.step(sensors_, dq_p_, next_.ddq_m, estimation_state_);
  control_.listen(sensors_, was_on_, control_state_);
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

// Whether a joint other than `joint` has left its place, or that one its reference.
bool Rig::is_astray(const VectorPM& from, int joint) const {
  const DeviceModel& model = config_.model;
  const VectorPM reference = stacked(q_p_reference_, now_.q_m);
  const VectorPM q = positions();
  for (int i = 0; i < q.size(); ++i) {
    const bool is_slide = model.chain.joints()[i].is_slide();
    if (i == joint) {
      if (std::abs(q[i] - reference[i]) > (is_slide ? kSlideAstray : kAstray)) return true;
    } else if (std::abs(q[i] - from[i]) > (is_slide ? kSlideStray : kStray)) {
      return true;
    }
  }
  return false;
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
  const auto periods = static_cast<int>(std::lround(kHold / dt()));
  for (int k = 0; k < periods; ++k) {
    exchange(true);
    moved = positions() - from;
    if (!is_astray(from, -1)) continue;
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
  for (int k = 0; k < periods; ++k) exchange(true);
}

FaultCode Rig::fall_silent(double duration_s) {
  const auto periods = static_cast<int>(std::lround(duration_s / dt()));
  for (int k = 0; k < periods; ++k) {
    machine_.read(sensors_);
    if (sensors_.driver_fault == FaultCode::kNone) continue;
    was_on_ = false;
    return sensors_.driver_fault;
  }
  command_.sequence = sensors_.sequence;
  disable(command_);
  machine_.write(command_);
  was_on_ = false;
  return FaultCode::kNone;
}

Stroke Rig::lead(int joint, double way) {
  const DeviceModel& model = config_.model;
  const int n_p = model.n_p;
  const ReferenceState start = next_;
  Stroke stroke = {.joint = joint, .by_speed = VectorM::Zero(model.n_m)};
  stroke.has_gyroscope = required_.has_imu;
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  const auto still = static_cast<int>(std::lround(kBias / dt()));
  for (int k = 0; k < still; ++k) {
    exchange(true);
    bias += sensors_.omega_S / still;
  }
  const VectorPM from = positions();
  const VectorM motors_from = robot_.theta_m;
  double t = 0.0, pace = 0.0, without_key = 0.0, lag = 0.0, torque = 0.0;
  int in_the_middle = 0;
  const double settled = kDuration + kSettle;
  while (t < settled) {
    const bool is_held = crew_.holds_key();
    pace = std::clamp(pace + (is_held ? dt() : -dt()) / kFade, 0.0, 1.0);
    without_key = is_held ? 0.0 : without_key + dt();
    if (without_key > kPatience) {
      power_off();
      throw Ended{"the key was let go of"};
    }
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
    exchange(true);
    stroke.way = way * at.position;
    stroke.moved = positions() - from;
    if (robot_.theta_m.size() > 0) stroke.motors = robot_.theta_m - motors_from;
    stroke.by_speed += dt() * sensors_.dq_m;
    stroke.turned += dt() * (sensors_.omega_S - bias);
    lag += dt() * (stroke.way - stroke.moved[joint]);
    if (joint >= n_p && command_.tau_m.size() > 0 && std::abs(t / kDuration - 0.5) < kMiddle) {
      torque += command_.tau_m[joint - n_p];
      ++in_the_middle;
    }
    if (is_astray(from, joint)) {
      power_off();
      stroke.is_cut = true;
      return stroke;
    }
  }
  if (in_the_middle > 0) stroke.torque = torque / in_the_middle;
  stroke.late = lag / way;
  return stroke;
}

}  // namespace hg::bring_up

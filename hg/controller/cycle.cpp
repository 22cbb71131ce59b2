#include "hg/controller/cycle.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

#include "hg/controller/safety/stopping.h"
#include "hg/controller/state_hash.h"

namespace hg::controller {
namespace {

using safety::kBrakingRate;
using safety::kRampOut;
using safety::kStandstill;

constexpr double kSafeShare = 0.9;  // of the monitored safe speed
constexpr double kCoasting = 0.1;   // rad/s and m/s, threshold of motion
constexpr double kRampIn = 0.3;     // s, ramp of the forces at the start of a run

bool stands_still(const CycleRecord& record) noexcept {
  return record.twin.dq_a.lpNorm<Eigen::Infinity>() < kStandstill &&
         record.reference.dq_m.lpNorm<Eigen::Infinity>() < kStandstill &&
         record.robot.dq_p.lpNorm<Eigen::Infinity>() < kStandstill;
}

// On measured speeds: the threshold is above encoder noise and the motion of a braked arm's springs
// under a hand.
bool is_coasting(const RobotState& robot) noexcept {
  return robot.dq_m.lpNorm<Eigen::Infinity>() > kCoasting ||
         robot.dq_p.lpNorm<Eigen::Infinity>() > kCoasting;
}

bool is_moving(Mode mode) noexcept { return mode == Mode::kRunning || mode == Mode::kStopping; }

// Deceleration of joints braked without the law.
VectorM braking_of(const rendering::DeviceModel& device) {
  constexpr double kWithoutRating = 10.0;  // rad/s^2 or m/s^2
  VectorM ddq(device.n_m);
  for (int i = 0; i < device.n_m; ++i) {
    const double rating = device.joint_limits[static_cast<std::size_t>(i)].ddq_max;
    ddq[i] = std::isfinite(rating) ? rating : kWithoutRating;
  }
  return ddq;
}

safety::MonitorConfig monitor_config(const Config& config) {
  safety::MonitorConfig monitor = config.monitor;
  monitor.has_imu = config.estimation.wrench.has_imu;
  monitor.dt = config.rendering.dt;
  return monitor;
}

prepositioning::TargetConfig target_of(const prepositioning::Config& gantry,
                                       const rendering::DeviceModel& device) {
  prepositioning::TargetConfig target = {.has_closed_form = gantry.has_closed_form,
                                         .n_p = device.n_p,
                                         .n_m = device.n_m,
                                         .handle = device.handle,
                                         .goal = device.posture};
  target.range.assign(gantry.q_limits.begin(), gantry.q_limits.begin() + device.n_p);
  for (const limits::JointLimits& joint : device.joint_limits) {
    target.range.push_back({joint.q_min, joint.q_max});
  }
  return target;
}

// Whether a lost command link can cause this fault as a consequence.
bool follows_from_link(FaultCode code) noexcept {
  switch (code) {
    case FaultCode::kJointTorqueExceeded:
    case FaultCode::kMotorDeviates:
    case FaultCode::kTorqueUnexplained:
    case FaultCode::kTurnUnexplained:
    case FaultCode::kMotionUnexplained:
    case FaultCode::kLimitExceeded:
    case FaultCode::kSpeedExceeded:
    case FaultCode::kTrackingLost:
    case FaultCode::kSyncLost:
    case FaultCode::kGantryExceeded:
    case FaultCode::kGantryDeviates:
    case FaultCode::kAccelerationExceeded:
    case FaultCode::kBrakingPosition:
    case FaultCode::kBrakingSpeed:
    case FaultCode::kStopTooFar:
      return true;
    default:
      return false;
  }
}

// Whether the end of a range or a surface pushes back. Limits of acceleration do so in every
// oscillation, so that only limits that are near count.
bool is_pushed_back(const CycleRecord& record) noexcept {
  constexpr double kPush = 0.5;   // N, or Nm of a limit
  constexpr double kNear = 0.05;  // m or rad
  for (int i = 0; i < record.limit_count; ++i) {
    const LimitReport& limit = record.limits[static_cast<std::size_t>(i)];
    const double left = std::min(limit.to_lower, limit.to_upper);
    if (left < kNear && std::abs(limit.reaction) > kPush) return true;
  }
  return record.contact.force.norm() > kPush;
}

}  // namespace

Cycle::Cycle(const Config& config, const rendering::DeviceModel& device,
             const rendering::TwinModel& twin)
    : config_(config),
      estimation_(config.estimation, device.chain, device.n_p, device.n_m, device.handle),
      rendering_(device, twin, config.rendering,
                 surfaces::Environment(config.surfaces, config.rendering.dt,
                                       rendering::felt_mass(twin).mass)),
      control_(config.control, device.chain, device.n_p, device.n_m, device.handle),
      gantry_target_(target_of(config.prepositioning, device), device.chain),
      guard_(config.collision, device.chain),
      monitor_(monitor_config(config), device.n_p, device.n_m),
      sanitiser_(config.sanitiser, monitor_.config()) {
  ddq_max_ = braking_of(device);
  longest_stop_ = static_cast<int>(std::lround(config.monitor.stop_time / config.rendering.dt));
  prepositioning::check(config_.prepositioning);
  state_.rendering = rendering_.start(VectorM::Zero(device.n_m));
  state_.control = control_.start();
  state_.dq_p = VectorP::Zero(device.n_p);
}

void Cycle::step(const SensorFrame& sensors, const OperatorFrame& operator_input,
                 CommandFrame& command, CycleRecord& record) noexcept HG_NONBLOCKING {
  std::destroy_at(&record);  // rebuilt in place: `record = {}` would copy an empty one
  ::new (&record) CycleRecord;
  record.cycle = state_.cycle;
  record.time_s = static_cast<double>(state_.cycle) * config_.rendering.dt;

  // supervisor: is this sample usable, which mode is permitted
  if (state_.cycle == 0) state_.next_sequence = sensors.sequence;
  supervise(sensors, operator_input, record);

  record.change = rendering_.change(operator_input.change, state_.rendering);
  ended_(Stage::kSupervision);

  // estimation -> prepositioning -> rendering
  if (safety::is_finite(monitor_.config(), sensors)) {
    record.robot =
        estimation_.step(sensors, state_.dq_p, state_.rendering.reference.ddq_m, state_.estimation);
    if (estimation_.has_units()) record.inertial = estimation_.inertial_report(state_.estimation);
    trust_wrench(sensors, record.robot);
    estimation_.check_motion(sensors, safety::is_powered(state_.supervisor.state),
                             state_.estimation);
    state_.is_coasting = is_coasting(record.robot);
    ended_(Stage::kEstimation);
    // positions after a jump are unusable, and the jump is itself the fault
    if (!monitor_.has_jumped(sensors, state_.monitor)) look_ahead(record);
    if (is_moving(state_.supervisor.mode())) {
      render(is_held(sensors), record);
    } else {
      hold(record);
    }
    monitor(sensors, operator_input.late_cycles, record);
  } else {
    safety::Monitor::forget(state_.monitor);
  }

  const Fault slip = safety::watch_brakes(
      monitor_.config(), sensors, safety::is_powered(state_.supervisor.state), state_.brakes);
  if (slip.code != FaultCode::kNone) safety::break_rule(slip, state_.supervisor);

  // control -> sanitiser
  write_command(sensors, operator_input, command, record);
  feel_touch(command.enable, record);
  ended_(Stage::kControl);
  sanitise(command, record);
  ended_(Stage::kSafety);

  state_.dq_p = command.dq_p;
  state_.q_m = command.q_m;
  state_.tau_m = command.tau_m;
  state_.was_on = command.enable;
  state_.next_sequence = sensors.sequence + 1;
  ++state_.cycle;
  const safety::SupervisorState& supervisor = state_.supervisor;
  record.mode = supervisor.mode();
  record.is_autonomous = supervisor.state == safety::State::kAutonomous;
  record.stop = supervisor.stop;
  record.fault = supervisor.fault;
  if (supervisor.also.code != FaultCode::kNone) record.warning = supervisor.also;
  record.tare = state_.estimation.wrench.tare.status;
  record.is_tared = estimation_.is_tared(state_.estimation);
  record.is_latency_known = control_.is_latency_known(state_.control);
  record.state_hash = hash_of(state_, rendering_.problem().rows());
  ended_(Stage::kStateHash);
}

void Cycle::watch(const StageProbe& probe) noexcept {
  ended_ = probe;
  rendering_.watch(probe);
}

void Cycle::supervise(const SensorFrame& sensors, const OperatorFrame& operator_input,
                      CycleRecord& record) noexcept {
  safety::SupervisorState& supervisor = state_.supervisor;
  const ModeRequest request = operator_input.request;
  // the panel's emergency stop acts on every device
  SafetyInputs safety = sensors.safety;
  safety.emergency_stop = safety.emergency_stop || operator_input.panel.emergency_stop;
  const bool is_new = request != supervisor.last_request;
  const bool was_fault = supervisor.state == safety::State::kFault;
  const bool is_arming = is_new && request == ModeRequest::kArm;
  const Fault fault = check(sensors);
  safety::SupervisorInput input = {
      .request = request,
      .is_held = is_held(sensors),
      .safety = safety,
      .to_arm = is_arming ? refusal_to_arm() : Refusal::kNone,
      .is_broken = state_.monitor.is_broken || state_.brakes.slip.code != FaultCode::kNone,
      .fault = safety::check_safety_inputs(safety, supervisor),
      // no control with such a sample
      .reaction = fault.code != FaultCode::kNone ? Stop::kSto : Stop::kNone};
  if (input.fault.code == FaultCode::kNone) input.fault = fault;
  record.refusal = safety::advance(input, supervisor);
  if (was_fault && supervisor.state != safety::State::kFault) begin_anew();

  estimation_.tare(is_new && request == ModeRequest::kTare, !is_moving(supervisor.mode()),
                   state_.estimation);
}

Fault Cycle::check(const SensorFrame& sensors) noexcept {
  const Fault fault = safety::check_sensors(monitor_.config(), sensors, state_.next_sequence);
  if (fault.code != FaultCode::kNone) return fault;
  const bool is_on = safety::is_powered(state_.supervisor.state);
  control_.listen(sensors, is_on, state_.control);
  return is_on ? control_.check_latency(sensors, state_.control) : Fault{};
}

Refusal Cycle::refusal_to_arm() const noexcept {
  if (state_.is_coasting) return Refusal::kStillMoving;
  if (state_.is_apart) return Refusal::kTwinApart;
  if (estimation::tilt(state_.estimation.inertial) > monitor_.config().tilt_tolerance) {
    return Refusal::kPostureImplausible;
  }
  if (!estimation_.is_tared(state_.estimation)) return Refusal::kNotTared;
  if (!control_.is_latency_known(state_.control)) return Refusal::kLatencyUnknown;
  if (!control_.is_stable(state_.control)) return Refusal::kLatencyTooLong;
  return Refusal::kNone;
}

// Resets estimation and control after a fault; keeps what was measured at rest.
void Cycle::begin_anew() noexcept {
  const estimation::TareState tare = state_.estimation.wrench.tare;
  const estimation::InertialCheck& before = state_.estimation.inertial;
  const estimation::InertialCheck inertial = {.bias = before.bias,
                                              .rest_samples = before.rest_samples};
  state_.estimation = {};
  state_.estimation.wrench.tare = tare;
  state_.estimation.inertial = inertial;
  control_.restart(state_.control);
  const TwinState& twin = state_.rendering.twin;
  if (twin.q_a.allFinite() && twin.dq_a.allFinite()) return;
  state_.rendering = rendering_.start(state_.rendering.reference.q_m);
}

// Beyond the sensor's range its reading is invalid: the last valid wrench is used until the rule
// trips and during the stop.
void Cycle::trust_wrench(const SensorFrame& sensors, RobotState& robot) noexcept {
  if (safety::is_wrench_in_range(monitor_.config(), sensors)) {
    state_.w_H = robot.w_H;
  } else {
    robot.w_H = state_.w_H;
  }
}

// Checks whether braking now avoids all collisions. The prediction assumes that all joints brake at
// once, so the joints then brake like that: the law's own stopping path may differ.
void Cycle::look_ahead(CycleRecord& record) noexcept {
  const RobotState& robot = record.robot;
  const safety::State state = state_.supervisor.state;
  const collision::Prediction ahead =
      guard_.step(stacked(robot.q_p, robot.q_m), stacked(robot.dq_p, robot.dq_m),
                  safety::is_powered(state), state_.collision);
  record.collision = ahead.report;
  if (!ahead.must_brake || !is_moving(safety::mode_of(state))) return;
  state_.brakes_joints = true;
  if (safety::mode_of(state) == Mode::kStopping) return;
  safety::break_rule({.code = FaultCode::kCollisionAhead,
                      .index = static_cast<std::int16_t>(ahead.report.pair),
                      .value = ahead.report.distance,
                      .limit = ahead.allowed},
                     state_.supervisor);
}

// Monitors energy and oscillation at the handle; added damping and inertia act from the next cycle.
void Cycle::watch_energy(CycleRecord& record) noexcept {
  if (config_.passivity.reaction == passivity::Reaction::kOff) return;
  const rendering::State& rendering = state_.rendering;
  const Vector6 twist_E = rendering_.end_effector_twist(rendering);
  const Vector6& w = record.robot.w_H;
  const Budget& budget = record.budget;
  record.passivity =
      passivity::step(config_.passivity,
                      {.f = w.head<3>(),
                       .power_measured = w.dot(rendering_.handle_twist(record.robot)),
                       .power_rendered = w.dot(twist_E),
                       .dissipation = (budget.damping + budget.friction).dot(rendering.twin.dq_a),
                       .mass = rendering_.apparent_mass(rendering),
                       .speed = twist_E.head<3>().norm(),
                       .is_pushed_back = is_pushed_back(record)},
                      state_.passivity);
  const passivity::Calming& calming = state_.passivity.calming;
  state_.rendering.calming = {calming.damping, calming.inertia};
  const Fault fault = passivity::check(config_.passivity, record.passivity, state_.passivity);
  if (fault.code != FaultCode::kNone) safety::break_rule(fault, state_.supervisor);
}

// Contact with the arm pushes twin and gantry from the next cycle on. Detection needs joint torques
// and is active while the law moves the arm. During a stop caused by the contact the arm yields in
// the first third of the stop time, faded out within 50 ms to leave time for braking; during any
// other stop it does not.
void Cycle::feel_touch(bool is_on, CycleRecord& record) noexcept {
  const safety::SupervisorState& supervisor = state_.supervisor;
  constexpr double kFade = 0.05;  // s
  double share = 1.0;
  if (supervisor.mode() == Mode::kStopping) {
    const double left = (longest_stop_ / 3 - supervisor.stop_samples) * config_.rendering.dt;
    const bool is_stopped_by_it = supervisor.fault.code == FaultCode::kTorqueUnexplained;
    share = is_stopped_by_it ? std::clamp(left / kFade, 0.0, 1.0) : 0.0;
  }
  const bool gives_way = share > 0.0 && is_moving(supervisor.mode());
  compliance::State& touch = state_.touch;
  const VectorM& dq = record.robot.dq_m;
  const bool is_known = config_.compliance.torque_max.size() == dq.size() && dq.size() > 0;
  if (!config_.compliance.is_on || !is_on || !gives_way || !is_known || state_.brakes_joints) {
    touch = {};
    state_.rendering.touch.setZero();
    return;
  }
  if (touch.dq.size() == dq.size()) {
    const tracking::JointControl::JointTorques torques =
        control_.joint_torques(record.robot, (dq - touch.dq) / config_.rendering.dt);
    record.touch = compliance::step(config_.compliance,
                                    {.torque = torques.external,
                                     .load = torques.motion,
                                     .J = rendering_.handle_jacobian(),
                                     .n_p = static_cast<int>(record.robot.q_p.size())},
                                    touch);
  }
  touch.dq = dq;
  state_.rendering.touch = share * record.touch.wrench;
}

// Standstill. Before arming, the device may be moved from outside: the twin follows. After joints
// braked without the law the twin is realigned with the handle.
void Cycle::hold(CycleRecord& record) noexcept {
  rendering::State& rendering = state_.rendering;
  const bool is_armed = state_.supervisor.state == safety::State::kArmed;
  if (!is_armed) {
    rendering.reference.q_m = record.robot.q_m;
    rendering.contact = {};
  }
  if (!is_armed || state_.brakes_joints) rendering_.align(record.robot, rendering);
  rendering.reference.dq_m.setZero();
  rendering.twin.dq_a.setZero();
  rendering_.step(rendering, kBrakingRate, record, 0.0);
  rendering_.gantry_room(state_.room.down, state_.room.up);
  state_.is_apart = record.sync_error > monitor_.config().sync_tolerance;
  rendering.reference.ddq_m.setZero();
  rendering.twin.ddq_a.setZero();
  record.reference = rendering.reference;
  record.twin = rendering.twin;
  state_.dq_p.setZero();
  state_.is_blocked = state_.brakes_joints = false;
  pulled_back_.resize(0);
  state_.force_share = 0.0;
  state_.passivity = {};
  rendering.calming = {};
}

// A requested stop ramps forces down if the handle is held; all other stops drop them at once.
void Cycle::render(bool is_held, CycleRecord& record) noexcept {
  const bool is_stopping = state_.supervisor.mode() == Mode::kStopping;
  double& share = state_.force_share;
  const bool is_alone = state_.supervisor.state == safety::State::kAutonomous;
  if (!is_stopping) state_.was_alone = is_alone;
  const bool is_gentle =
      is_held && !state_.was_alone && state_.supervisor.state == safety::State::kToArmed;
  if (is_stopping && !is_gentle) share = 0.0;
  pulled_back_ = state_.rendering.reference.q_m;
  const bool has_left =
      rendering_.stay_near(record.robot, config_.control.error_max, state_.rendering);
  if (has_left) pulled_back_ -= state_.rendering.reference.q_m;
  if (!has_left) pulled_back_.resize(0);
  const double speed = is_alone ? kSafeShare * monitor_.config().safe_speed : kInfinity;
  const VectorP q_p_target =
      gantry_target_.step(record.robot, state_.rendering.reference.q_m, state_.gantry_target);
  const prepositioning::Command gantry =
      prepositioning::step(config_.prepositioning, record.robot, q_p_target, state_.is_blocked,
                           speed / std::sqrt(2.0), state_.room, state_.touch.away);
  record.q_p_target = gantry.q_target;
  const DriveModel& drive = config_.estimation.drive;
  const bool leads = rendering_.leads_gantry() && !is_stopping;
  GantryTask gantry_task;
  if (leads) {
    gantry_task = prepositioning::accelerations(gantry, drive, record.robot, state_.rendering.ddq_p,
                                                config_.rendering.dt);
    gantry_task.unexplained = estimation_.gantry_disturbance(state_.estimation);
  }
  ended_(Stage::kPrepositioning);
  const double braking = is_stopping ? kBrakingRate * (1.0 - share) : 0.0;
  rendering_.step(state_.rendering, state_.touch.is_told ? kBrakingRate : braking, record, share,
                  speed / std::sqrt(3.0), gantry_task);
  rendering_.gantry_room(state_.room.down, state_.room.up);
  const double step =
      is_stopping ? -config_.rendering.dt / kRampOut : config_.rendering.dt / kRampIn;
  share = std::clamp(share + step, 0.0, 1.0);

  if (!is_stopping) watch_energy(record);

  const Fault unsolved = safety::check_solution(record);
  if (unsolved.code != FaultCode::kNone) {
    safety::break_rule(unsolved, state_.supervisor);
    state_.brakes_joints = true;
  }
  state_.dq_p = is_stopping ? VectorP::Zero(gantry.dq.size()) : gantry.dq;
  if (leads) {
    state_.dq_p = prepositioning::velocity_for(state_.rendering.ddq_p, gantry, drive, record.robot);
  }
  state_.is_blocked = rendering_.is_blocked();
  record.tracking.is_clamped = has_left;
  if (state_.brakes_joints) brake_joints(record);
  rendering_.integrate(state_.rendering);
  if (is_stopping) {
    safety::go_on_stopping(share == 0.0 && stands_still(record), longest_stop_,
                           config_.monitor.stop_time, state_.supervisor);
  }
  ended_(Stage::kIntegration);
}

// Without a solution the law cannot brake, and its stopping path may lead to a collision: joints
// brake with their own ratings, for which their position limits leave room; twin and gantry do not
// follow. [HANDBOOK] 6.2 has a ramp of 50 ms, which exceeds the motor torques of a stretched arm.
void Cycle::brake_joints(CycleRecord& record) noexcept {
  rendering::State& rendering = state_.rendering;
  ReferenceState& reference = rendering.reference;
  const double rate = 1.0 / config_.rendering.dt;
  reference.ddq_m = (-rate * reference.dq_m).cwiseMin(ddq_max_).cwiseMax(-ddq_max_);
  rendering.twin.dq_a.setZero();
  rendering.twin.ddq_a.setZero();
  record.reference = reference;
  record.twin = rendering.twin;
  record.sync_error = 0.0;
  state_.dq_p.setZero();
}

void Cycle::monitor(const SensorFrame& sensors, std::uint32_t late_cycles,
                    CycleRecord& record) noexcept {
  const safety::Verdict verdict =
      monitor_.watch(sensors, record,
                     {.state = state_.supervisor.state,
                      .late_cycles = late_cycles,
                      .dq_p_command = state_.dq_p,
                      .tau_m = state_.tau_m,
                      .pulled_back = pulled_back_,
                      .unexplained = state_.control.unexplained,
                      .turn = state_.estimation.inertial.turn.norm(),
                      .turn_uncertainty = estimation::turn_uncertainty(state_.estimation.inertial),
                      .slip = state_.estimation.inertial.slip.norm(),
                      .slip_uncertainty = estimation::slip_uncertainty(state_.estimation.inertial)},
                     state_.monitor);
  record.warning = verdict.warning;
  if (!state_.monitor.is_broken) return;
  const Fault link = follows_from_link(verdict.fault.code)
                         ? control_.link_disturbance(sensors, state_.control)
                         : Fault{};
  safety::break_rule(link.code != FaultCode::kNone ? link : verdict.fault, state_.supervisor);
}

void Cycle::sanitise(CommandFrame& command, CycleRecord& record) noexcept {
  const safety::Sanitised sanitised = sanitiser_.step({.robot = record.robot,
                                                       .was_on = state_.was_on,
                                                       .q_before = state_.q_m,
                                                       .tau_before = state_.tau_m},
                                                      command);
  record.sanitised = sanitised.changed;
  if (sanitised.fault.code == FaultCode::kNone) return;
  safety::break_rule(sanitised.fault, state_.supervisor);
}

void Cycle::write_command(const SensorFrame& sensors, const OperatorFrame& operator_input,
                          CommandFrame& command, CycleRecord& record) noexcept {
  command.sequence = sensors.sequence;
  command.enable = safety::is_powered(state_.supervisor.state);
  command.dq_p = state_.dq_p;
  const ReferenceState& reference = state_.rendering.reference;
  if (command.enable) {
    control_.step(record.reference, reference, record.robot, state_.control, command,
                  record.tracking);
  } else {
    control_.rest(reference, state_.control, command);
    command.dq_p.setZero();
  }
  command.hand_target = operator_input.hand_target;
  command.panel = operator_input.panel;
}

}  // namespace hg::controller

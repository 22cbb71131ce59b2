#include "hg/controller/cycle_stages.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <span>

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

// On measured speeds: the threshold is above encoder noise and the motion of a braked arm's springs
// under a hand.
bool is_coasting(const RobotState& robot) noexcept {
  return robot.dq_m.lpNorm<Eigen::Infinity>() > kCoasting ||
         robot.dq_p.lpNorm<Eigen::Infinity>() > kCoasting;
}

bool is_moving(Mode mode) noexcept { return mode == Mode::kRunning || mode == Mode::kStopping; }

// Whether the law's accelerations, or those of a stop, move the device.
bool is_moving(Motion motion) noexcept {
  return motion != Motion::kNone && motion != Motion::kHold;
}

bool is_stopping(Motion motion) noexcept {
  return motion == Motion::kRenderStop || motion == Motion::kBrakeJoints;
}

// Properties of the other parts on which the monitor's rules depend. The paper's bounds ask for
// more than any rating where they contradict each other, and where the law models torques they are
// what limits accelerations.
safety::MonitoredParts parts_of(const CycleConfig& config, const DeviceModel& device,
                                const rendering::TwinModel& twin) {
  const passivity::Reaction reaction = config.passivity.reaction;
  const bool is_paper = config.rendering.bounds == rendering::Bounds::kPaper;
  const double heaviest = rendering::felt_mass(twin).mass.ub;
  return {.has_imu = config.estimation.wrench.has_imu,
          .has_rated_bounds = !is_paper && device.has_rated_accelerations(),
          .looks_for_shaking = reaction != passivity::Reaction::kOff,
          .stops_shaking = reaction == passivity::Reaction::kAct,
          .twin_mass = std::isfinite(heaviest) ? heaviest : 0.0};
}

// Where limits brake together, the gantry never trusts the arm to take back what it does.
prepositioning::PrepositioningConfig gantry_config(const CycleConfig& config,
                                                   const DeviceModel& device) {
  prepositioning::PrepositioningConfig gantry = config.prepositioning;
  if (rendering::brakes_together(device, config.rendering)) gantry.taken_back = 0.0;
  return gantry;
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
    case FaultCode::kLimitNotHeld:
      return true;
    default:
      return false;
  }
}

// Whether the end of a range or a surface pushes back. Limits of acceleration do so in every
// oscillation, so that only limits that are near count.
bool is_pushed_back(const rendering::LawResult& law) noexcept {
  constexpr double kPush = 0.5;   // N, or Nm of a limit
  constexpr double kNear = 0.05;  // m or rad
  for (int i = 0; i < law.limit_count; ++i) {
    const LimitReport& limit = law.limits[i];
    const double left = std::min(limit.to_lower, limit.to_upper);
    if (left < kNear && std::abs(limit.reaction) > kPush) return true;
  }
  return law.contact.force.norm() > kPush;
}

// Whether torques of the twin are beyond those of a light touch.
bool is_load(const rendering::Rendering& rendering, const VectorA& torque) noexcept {
  Vector6 touch;
  touch << 0.3, 0.3, 0.3, 0.015, 0.015, 0.015;  // N, Nm
  const model::Jacobian& J_a = rendering.twin_chain().jacobian(rendering.twin().end_effector);
  const VectorA most = J_a.cwiseAbs().transpose().lazyProduct(touch);
  return !((torque.cwiseAbs() - most).maxCoeff() <= 0.0);
}

// Whether the twin has no spring where it is, and neither weight nor surfaces act on it.
bool is_free(const rendering::Rendering& rendering, const Budget& budget) noexcept {
  if (!budget.spring.isZero(0.0)) return false;
  const VectorA weight = rendering.twin_chain().gravity();
  return !is_load(rendering, budget.surface) && !is_load(rendering, weight);
}

// Whether the twin is slow, or the wrench delivers its energy within two seconds.
bool is_slow(const rendering::Rendering& rendering, const rendering::RenderingState& state,
             const rendering::LawResult& law) noexcept {
  constexpr double kSlow = 0.02, kSlowTurn = 0.1;  // m/s, rad/s
  constexpr double kWithin = 2.0;                  // s
  const Vector6 twist = rendering.end_effector_twist(state);
  if (twist.head<3>().norm() < kSlow && twist.tail<3>().norm() < kSlowTurn) return true;
  const VectorA& dq = state.twin.dq_a;
  const VectorA momentum = rendering.twin_chain().M().lazyProduct(dq);
  return kWithin * law.tau_a.dot(dq) >= 0.5 * momentum.dot(dq);
}

}  // namespace

CycleStages::CycleStages(const CycleConfig& config, const DeviceModel& device,
                         const rendering::TwinModel& twin)
    : config_(config),
      required_{.n_p = device.n_p,
                .n_m = device.n_m,
                .has_torque_loop = config.control.method != tracking::Method::kDrives,
                .has_imu = config.estimation.wrench.has_imu},
      dt_(device.dt()),
      estimation_(config.estimation, device),
      rendering_(device, twin, config.rendering,
                 surfaces::Environment(config.surfaces, dt_, rendering::felt_mass(twin).mass)),
      control_(config.control, device),
      gantry_target_(device),
      prepositioning_(gantry_config(config, device), device),
      braking_(collision::braking_of(device, config.prepositioning.ddq_max)),
      guard_(config.collision, braking_, device.chain),
      monitor_(config.monitor, device, parts_of(config, device, twin)),
      sanitiser_(config.sanitiser, device, prepositioning_.dq_max()) {
  if (config.control.method != tracking::Method::kDrives) {
    torque_max_ = compliance::peak_torques(device);
  }
  state_.rendering = rendering_.start(VectorM::Zero(device.n_m));
  state_.control = control_.start();
  state_.dq_p = VectorP::Zero(device.n_p);
}

// supervisor -> estimation -> prepositioning -> rendering -> control -> sanitiser
void CycleStages::step(const SensorFrame& sensors, const OperatorFrame& operator_input,
                       CommandFrame& command, CycleRecord& record) noexcept HG_NONBLOCKING {
  const Supervision supervision = supervise(sensors, operator_input);
  ended_(Stage::kSupervision);

  const RobotState robot = supervision.is_usable ? estimate(sensors) : RobotState{};
  ended_(Stage::kEstimation);

  const collision::Prediction ahead = look_ahead(sensors, robot);
  const Motion motion = decide(supervision.is_usable, ahead.must_brake);

  const VectorM pulled_back = place_reference(motion, robot);
  const GantryAim gantry = preposition(motion, robot);
  ended_(Stage::kPrepositioning);

  const rendering::LawResult& law =
      render(motion, is_held(sensors), robot, gantry, supervision.twin_force);
  const PassivityReport passivity = watch_energy(motion, robot, law);
  watch_rest(motion, robot, law);
  const Moved moved = advance(motion, robot, gantry, law);
  time_stop(motion, robot, moved);
  ended_(Stage::kIntegration);

  const Results results = {supervision, robot, ahead.report, motion, pulled_back,
                           gantry,      law,   passivity,    moved};
  const Fault warning = monitor(sensors, operator_input.late_cycles, results);

  command.sequence = sensors.sequence;
  command.hand_target = operator_input.hand_target;
  command.panel = operator_input.panel;
  const TrackingReport tracking = control(robot, moved, command);
  const TouchReport touch = feel_touch(command.enable, robot);
  ended_(Stage::kControl);

  const std::uint32_t sanitised = sanitise(robot, command);
  ended_(Stage::kSafety);

  remember(sensors.sequence, command);
  fill(results, warning, tracking, touch, sanitised, record);
  ended_(Stage::kStateHash);
}

void CycleStages::watch(const StageProbe& probe) noexcept {
  ended_ = probe;
  rendering_.watch(probe);
}

// Is this sample usable, which mode is permitted, which parameters change.
CycleStages::Supervision CycleStages::supervise(const SensorFrame& sensors,
                                                const OperatorFrame& operator_input) noexcept {
  const Fault values = check_values(sensors, required_);
  Supervision result = {.is_usable = values.code == FaultCode::kNone};
  if (state_.cycle == 0) state_.next_sequence = sensors.sequence;
  safety::SupervisorState& supervisor = state_.supervisor;
  const ModeRequest request = operator_input.request;
  // the panel's emergency stop acts on every device
  SafetyInputs safety = sensors.safety;
  safety.emergency_stop = safety.emergency_stop || operator_input.panel.emergency_stop;
  const bool is_new = request != supervisor.last_request;
  const bool was_fault = supervisor.state == safety::SafetyState::kFault;
  const bool is_arming = is_new && request == ModeRequest::kArm;
  const Fault fault = check(sensors, values);
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
  if (!operator_input.twin_force.is_zero()) {
    const Fault wrong = check(operator_input.twin_force);
    if (wrong.code == FaultCode::kNone) result.twin_force = &operator_input.twin_force;
    if (input.fault.code == FaultCode::kNone) input.fault = wrong;
  }
  if (operator_input.twin_base.is_moving) {
    const Fault wrong = check(operator_input.twin_base);
    if (wrong.code == FaultCode::kNone) rendering_.move_base(operator_input.twin_base);
    if (input.fault.code == FaultCode::kNone) input.fault = wrong;
  }
  result.refusal = safety::advance(input, supervisor);
  if (was_fault && supervisor.state != safety::SafetyState::kFault) reset_controllers();

  estimation_.tare(is_new && request == ModeRequest::kTare, !is_moving(supervisor.mode()),
                   state_.estimation);
  result.change = rendering_.change(operator_input.change, state_.rendering);
  return result;
}

Fault CycleStages::check(const SensorFrame& sensors, const Fault& values) noexcept {
  const Fault fault = safety::check_sensors(sensors, state_.next_sequence, values);
  if (fault.code != FaultCode::kNone) return fault;
  const bool is_on = safety::is_powered(state_.supervisor.state);
  control_.listen(sensors, is_on, state_.control);
  return is_on ? control_.check_latency(sensors, state_.control) : Fault{};
}

// Values per joint, finite, and no more than what the user may do to the handle.
Fault CycleStages::check(const TwinForce& force) const noexcept {
  constexpr double kLever = 1.0;  // m
  const auto wrong = [](Eigen::Index index, double value, double limit) {
    return Fault{FaultCode::kTwinForceWrong, static_cast<std::int16_t>(index), value, limit};
  };
  const int n_a = rendering_.twin().chain.nv();
  const auto joints = static_cast<int>(force.tau.size());
  if (joints != 0 && joints != n_a) return wrong(-1, joints, n_a);
  const double force_max = monitor_.config().force_max, torque_max = monitor_.config().torque_max;
  for (int i = 0; i < 6 + joints; ++i) {
    const double value = i < 6 ? force.w_E[i] : force.tau[i - 6];
    const double limit = i < 3 ? force_max : i < 6 ? torque_max : kLever * force_max + torque_max;
    if (!(std::abs(value) <= limit)) return wrong(i, value, limit);
  }
  return {};
}

// Finite, and no faster than a person is carried.
Fault CycleStages::check(const TwinBase& base) const noexcept {
  constexpr std::array<double, 3> kLargest = {kInfinity, 2.0, 10.0};  // m; m/s, rad/s; per s
  const std::array<Vector6, 3> motion = {
      (Vector6() << base.T_B_A.p, base.T_B_A.R.rowwise().sum()).finished(), base.twist,
      base.acceleration};
  for (int i = 0; i < 18; ++i) {
    const double value = motion[i / 6][i % 6], limit = kLargest[i / 6];
    if (std::abs(value) <= limit && std::isfinite(value)) continue;
    return {FaultCode::kTwinForceWrong, static_cast<std::int16_t>(6 + kMaxTwin + i), value, limit};
  }
  return {};
}

Refusal CycleStages::refusal_to_arm() const noexcept {
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
void CycleStages::reset_controllers() noexcept {
  const estimation::TareState tare = state_.estimation.wrench.tare;
  const estimation::InertialCheck& before = state_.estimation.inertial;
  const estimation::InertialCheck inertial = {.bias = before.bias,
                                              .rest_samples = before.rest_samples};
  const estimation::RestState rest = {.zero = state_.estimation.rest.zero};
  state_.estimation = {};
  state_.estimation.rest = rest;
  state_.estimation.wrench.tare = tare;
  state_.estimation.inertial = inertial;
  control_.restart(state_.control);
  const TwinState& twin = state_.rendering.twin;
  if (twin.q_a.allFinite() && twin.dq_a.allFinite()) return;
  state_.rendering = rendering_.start(state_.rendering.reference.q_m);
}

// The state of the device. Beyond the force sensor's range its reading is invalid: the last valid
// wrench is used until the rule trips and during the stop.
RobotState CycleStages::estimate(const SensorFrame& sensors) noexcept {
  RobotState robot =
      estimation_.step(sensors, state_.dq_p, state_.rendering.reference.ddq_m, state_.estimation);
  if (safety::is_wrench_in_range(monitor_.config(), sensors)) {
    state_.w_H = robot.w_H;
  } else {
    robot.w_H = state_.w_H;
  }
  estimation_.check_motion(sensors, safety::is_powered(state_.supervisor.state), state_.estimation);
  state_.is_coasting = is_coasting(robot);
  return robot;
}

// Checks whether braking now avoids all collisions. Positions after a jump are unusable, and the
// jump is itself the fault.
collision::Prediction CycleStages::look_ahead(const SensorFrame& sensors,
                                              const RobotState& robot) noexcept {
  if (robot.q_m.size() == 0 || monitor_.has_jumped(sensors, state_.monitor)) return {};
  const safety::SafetyState state = state_.supervisor.state;
  const collision::Prediction ahead =
      guard_.step(stacked(robot.q_p, robot.q_m), stacked(robot.dq_p, robot.dq_m),
                  safety::is_powered(state), state_.collision);
  if (ahead.must_brake && safety::mode_of(state) == Mode::kRunning) {
    safety::break_rule({.code = FaultCode::kCollisionAhead,
                        .index = static_cast<std::int16_t>(ahead.report.pair),
                        .value = ahead.report.distance,
                        .limit = ahead.allowed},
                       state_.supervisor);
  }
  return ahead;
}

// The prediction of collisions assumes that all joints brake at once, so they then brake like that:
// the law's own stopping path may differ.
Motion CycleStages::decide(bool is_usable, bool must_brake) const noexcept {
  if (!is_usable) return Motion::kNone;
  const Mode mode = state_.supervisor.mode();
  if (!is_moving(mode)) return Motion::kHold;
  const bool has_braked = state_.motion == Motion::kBrakeJoints;
  if (has_braked && mode == Mode::kRunning) return Motion::kHold;  // one cycle, to realign the twin
  if (must_brake || has_braked) return Motion::kBrakeJoints;
  return mode == Mode::kStopping ? Motion::kRenderStop : Motion::kRender;
}

// Reference and twin from which the law starts. Standstill: before arming, the device may be moved
// from outside, and both follow it; after joints braked one by one the twin is realigned with the
// handle. In motion: both are moved back to a device that lags behind. Returns by how much the
// reference was moved back; empty = not at all.
VectorM CycleStages::place_reference(Motion motion, const RobotState& robot) noexcept {
  rendering::RenderingState& rendering = state_.rendering;
  if (motion == Motion::kHold) {
    const bool is_armed = state_.supervisor.state == safety::SafetyState::kArmed ||
                          is_moving(state_.supervisor.mode());
    if (!is_armed) {
      rendering.reference.q_m = robot.q_m;
      rendering.contact = {};
    }
    if (!is_armed || state_.motion == Motion::kBrakeJoints) rendering_.align(robot, rendering);
    rendering.reference.dq_m.setZero();
    rendering.twin.dq_a.setZero();
  }
  if (!is_moving(motion)) return {};
  const VectorM before = rendering.reference.q_m;
  if (!rendering_.clamp_reference(robot, config_.control.error_max, rendering)) return {};
  return before - rendering.reference.q_m;
}

// Largest speed of handle and gantry, m/s.
double CycleStages::speed_max() const noexcept {
  const bool is_alone = state_.supervisor.state == safety::SafetyState::kAutonomous;
  return is_alone ? kSafeShare * monitor_.config().safe_speed : kInfinity;
}

// Desired motion of the gantry, and the range in which the law may lead it.
CycleStages::GantryAim CycleStages::preposition(Motion motion, const RobotState& robot) noexcept {
  if (!is_moving(motion)) return {};
  const VectorP q_p_target =
      gantry_target_.step(robot, state_.rendering.reference.q_m, state_.gantry_target);
  GantryAim aim = {.command = prepositioning_.step(robot, q_p_target, state_.is_blocked,
                                                   speed_max() / std::sqrt(2.0), state_.room,
                                                   state_.touch.away)};
  if (rendering_.leads_gantry() && motion == Motion::kRender) {
    aim.task = prepositioning_.accelerations(aim.command, robot, state_.rendering.ddq_p);
    aim.task.unexplained = estimation_.gantry_disturbance(state_.estimation);
  }
  return aim;
}

// Time in which forces fade in a stop, s. The joints of a device with a gantry go on meanwhile:
// less where one would move too far, which braking takes by another kBraking at its present speed.
double CycleStages::ramp_out() const noexcept {
  constexpr double kBraking = 0.2, kLeast = 0.02;  // s
  const DeviceModel& device = rendering_.device();
  double time = kRampOut;
  if (device.n_p == 0) return time;
  for (int i = 0; i < device.n_m; ++i) {
    const double way =
        safety::kUntilBrakes * monitor_.config().stop_distance_of_joint(device.is_slide(i));
    const double speed = std::abs(state_.rendering.reference.dq_m[i]);
    if (speed * (time + kBraking) > way) time = way / speed - kBraking;
  }
  return std::max(time, kLeast);
}

// Share of the forces on the twin in this cycle; sets that of the next one. A requested stop ramps
// forces down if the handle is held; all other stops drop them at once.
double CycleStages::ramp_forces(Motion motion, bool is_held, double fade_s) noexcept {
  if (!is_moving(motion)) return state_.force_share = 0.0;
  const safety::SafetyState state = state_.supervisor.state;
  if (!is_stopping(motion)) state_.was_alone = state == safety::SafetyState::kAutonomous;
  const bool is_gentle = is_held && !state_.was_alone && state == safety::SafetyState::kToArmed;
  const double share = is_stopping(motion) && !is_gentle ? 0.0 : state_.force_share;
  const double step = is_stopping(motion) ? -dt_ / fade_s : dt_ / kRampIn;
  state_.force_share = std::clamp(share + step, 0.0, 1.0);
  return share;
}

// What the law keeps apart: from the reference, which is what it accelerates.
CollisionTask CycleStages::keep_apart(Motion motion, const RobotState& robot) noexcept {
  if (!is_moving(motion) || !rendering_.device().keeps_apart) return {};
  const ReferenceState& reference = state_.rendering.reference;
  return guard_.keep_apart(stacked(robot.q_p, reference.q_m), stacked(robot.dq_p, reference.dq_m),
                           state_.collision);
}

// Accelerations of device and twin, and their causes. The law also runs while the device stands
// still: limits and the distance of handle and twin are shown, the distance is checked before
// arming, and the first motion starts with the active set. Its accelerations are then not used.
const rendering::LawResult& CycleStages::render(Motion motion, bool is_held,
                                                const RobotState& robot, const GantryAim& gantry,
                                                const TwinForce* twin_force) noexcept {
  if (motion == Motion::kNone) return law_;
  const double fade_s = ramp_out();
  const double share = ramp_forces(motion, is_held, fade_s);
  const bool is_braked = motion == Motion::kHold || state_.touch.is_reported;
  const double stop_rate = is_stopping(motion) ? kBrakingRate * (1.0 - share) : 0.0;
  // joints make up for a gantry that brakes until the forces are out, which an emergency stop drops
  // at once; what makes a joint faster then fades, or others would have to take it over at once
  constexpr double kFade = 0.2;  // of the time in which the forces fade
  const bool has_gantry = rendering_.device().n_p > 0;
  const bool slows_joints = (share == 0.0 || !has_gantry) && !state_.touch.is_reported;
  const double fading = has_gantry ? kFade : share;
  const double kept = fading * fade_s / (fading * fade_s + dt_);
  const double ramped_rate =
      is_stopping(motion) ? stop_rate : estimation::braking_rate(state_.estimation.rest);
  rendering_.step({.robot = robot,
                   .braking_rate = is_braked ? kBrakingRate : ramped_rate,
                   .joint_braking_rate = slows_joints ? stop_rate : 0.0,
                   .kept_acceleration = kept,
                   .force_share = share,
                   .handle_speed_max = speed_max() / std::sqrt(3.0),
                   .most_active_sets = most_active_sets(config_.solver_caps, time_s()),
                   .gantry = gantry.task,
                   .cycle = state_.cycle,
                   .collision = keep_apart(motion, robot),
                   .twin_force = twin_force},
                  state_.rendering, law_);
  rendering_.gantry_room(state_.room.down, state_.room.up);
  state_.is_blocked = is_moving(motion) && rendering_.is_blocked();
  if (motion == Motion::kHold) {
    state_.is_apart = law_.sync_error > monitor_.config().sync_tolerance;
  }
  return law_;
}

// Monitors energy and oscillation at the handle; added damping and inertia act from the next cycle.
PassivityReport CycleStages::watch_energy(Motion motion, const RobotState& robot,
                                          const rendering::LawResult& law) noexcept {
  rendering::RenderingState& rendering = state_.rendering;
  if (motion == Motion::kHold) {
    state_.passivity = {};
    rendering.added = {};
  }
  if (motion != Motion::kRender || config_.passivity.reaction == passivity::Reaction::kOff) {
    return {};
  }
  const Vector6 twist_E = rendering_.end_effector_twist(rendering);
  const Vector6& w = robot.w_H;
  const PassivityReport report = passivity::observe_energy(
      config_.passivity, dt_,
      {.f = w.head<3>(),
       .power_measured = w.dot(rendering_.handle_twist(robot) - rendering_.carried_twist()),
       .power_rendered = w.dot(twist_E),
       .dissipation = (law.budget.damping + law.budget.friction).dot(rendering.twin.dq_a) /
                      law.felt_scale.maxCoeff(),
       .mass = rendering_.apparent_mass(rendering),
       .speed = twist_E.head<3>().norm(),
       .is_pushed_back = is_pushed_back(law)},
      state_.passivity);
  rendering.added = state_.passivity.added;
  const Fault fault = passivity::passivity_fault(config_.passivity, report, state_.passivity);
  if (fault.code != FaultCode::kNone) safety::break_rule(fault, state_.supervisor);
  return report;
}

// Looks for drift of the force sensor's zero while the handle is free; at standstill only
// for one that would be felt.
void CycleStages::watch_rest(Motion motion, const RobotState& robot,
                             const rendering::LawResult& law) noexcept {
  if (motion == Motion::kNone) return;
  constexpr double kFelt = 0.3, kFeltTorque = 0.03;  // N, Nm
  estimation::RestInput input;
  if (motion == Motion::kHold) {
    const Vector6& w = state_.w_H;
    input.is_free = w.head<3>().norm() > kFelt || w.tail<3>().norm() > kFeltTorque;
    input.is_slow = true;
  } else if (motion == Motion::kRender) {
    input.v_H = rendering_.handle_twist(robot).head<3>();
    input.acceleration = law.a_H.norm();
    // not needed while a hand is on the handle
    if (state_.estimation.rest.is_untouched) {
      const VectorA held = law.budget.limits + law.budget.conflict;
      input.is_free = is_free(rendering_, law.budget);
      input.is_at_limit = is_load(rendering_, held);
      input.is_slow = is_slow(rendering_, state_.rendering, law);
    }
  }
  estimation_.watch_rest(input, state_.estimation);
}

// The motion that the solution permits: without a solution the law cannot brake.
Motion CycleStages::accept(Motion motion, const rendering::LawResult& law) noexcept {
  if (!is_moving(motion)) return motion;
  const Fault unsolved = safety::check_solution(law.solver_status, law.ddq_m, law.ddq_a);
  if (unsolved.code == FaultCode::kNone) return motion;
  safety::break_rule(unsolved, state_.supervisor);
  return Motion::kBrakeJoints;
}

// Moves reference and twin by one period, and determines the motion of the gantry.
CycleStages::Moved CycleStages::advance(Motion motion, const RobotState& robot,
                                        const GantryAim& gantry,
                                        const rendering::LawResult& law) noexcept {
  Moved moved = {.dq_p = VectorP::Zero(state_.dq_p.size())};
  if (motion == Motion::kNone) return moved;
  rendering::RenderingState& rendering = state_.rendering;
  motion = accept(motion, law);
  state_.motion = motion;
  if (motion == Motion::kHold) {
    rendering.reference.ddq_m.setZero();
    rendering.twin.ddq_a.setZero();
  }
  if (motion == Motion::kBrakeJoints) brake_joints(robot);
  const bool is_led = gantry.task.ddq.size() > 0;
  if (motion == Motion::kRender) {
    moved.dq_p = is_led ? prepositioning_.velocity_for(rendering.ddq_p, gantry.command, robot)
                        : gantry.command.dq;
  }
  moved.reference = rendering.reference;
  moved.twin = rendering.twin;
  moved.sync_error = motion == Motion::kBrakeJoints ? 0.0 : law.sync_error;
  if (is_moving(motion)) rendering_.integrate(rendering);
  return moved;
}

// Joints brake as the prediction of collisions assumes; twin and gantry do not follow. [HANDBOOK]
// 6.2 has a ramp of 50 ms, which exceeds the motor torques of a stretched arm.
void CycleStages::brake_joints(const RobotState& robot) noexcept {
  rendering::RenderingState& rendering = state_.rendering;
  const VectorM& dq = rendering.reference.dq_m;
  const VectorP still = VectorP::Zero(robot.q_p.size());
  const VectorPM braking = collision::decelerations(
      braking_, stacked(robot.q_p, rendering.reference.q_m), stacked(still, dq));
  const VectorM most = braking.tail(dq.size());
  rendering.reference.ddq_m = (-dq / dt_).cwiseMin(most).cwiseMax(-most);
  rendering.twin.dq_a.setZero();
  rendering.twin.ddq_a.setZero();
}

// Ends a stop once everything is at rest, or reports that it takes too long.
void CycleStages::time_stop(Motion motion, const RobotState& robot, const Moved& moved) noexcept {
  if (!is_stopping(motion)) return;
  const bool is_at_rest = state_.force_share == 0.0 &&
                          moved.twin.dq_a.lpNorm<Eigen::Infinity>() < kStandstill &&
                          moved.reference.dq_m.lpNorm<Eigen::Infinity>() < kStandstill &&
                          robot.dq_p.lpNorm<Eigen::Infinity>() < kStandstill;
  safety::continue_stop(is_at_rest, config_.monitor.stop_time, dt_, state_.supervisor);
}

// Compares measured and desired values with the thresholds of all rules, and watches the brakes.
// Returns the warning of this cycle.
Fault CycleStages::monitor(const SensorFrame& sensors, std::uint32_t late_cycles,
                           const Results& results) noexcept {
  safety::MonitorResult verdict;
  if (results.motion == Motion::kNone) {
    safety::Monitor::forget(state_.monitor);
  } else {
    const rendering::LawResult& law = results.law;
    const estimation::InertialCheck& inertial = state_.estimation.inertial;
    verdict = monitor_.watch(
        sensors,
        {.robot = results.robot,
         .reference = results.moved.reference,
         .limits = law.limits,
         .sync_error = results.moved.sync_error,
         .v_H = law.v_H,
         .contact_force = law.contact.force,
         .oscillation = results.passivity.oscillation,
         .passing = state_.motion == Motion::kBrakeJoints ? std::span<const double>()
                                                          : std::span<const double>(law.passing)},
        {.state = state_.supervisor.state,
         .late_cycles = late_cycles,
         .dq_p_command = results.moved.dq_p,
         .tau_m = state_.tau_m,
         .pulled_back = results.pulled_back,
         .unexplained = state_.control.unexplained,
         .turn = inertial.turn.norm(),
         .turn_uncertainty = estimation::turn_uncertainty(inertial),
         .slip = inertial.slip.norm(),
         .slip_uncertainty = estimation::slip_uncertainty(inertial)},
        state_.monitor);
    if (state_.monitor.is_broken) {
      const Fault link = follows_from_link(verdict.fault.code)
                             ? control_.link_disturbance(sensors, state_.control)
                             : Fault{};
      safety::break_rule(link.code != FaultCode::kNone ? link : verdict.fault, state_.supervisor);
    }
  }
  const Fault slip =
      safety::watch_brakes(monitor_.config(), rendering_.device(), sensors,
                           safety::is_powered(state_.supervisor.state), state_.brakes);
  if (slip.code != FaultCode::kNone) safety::break_rule(slip, state_.supervisor);
  return verdict.warning;
}

// The commands of the drives: from the reference at the time of the sample to the one a period
// later.
TrackingReport CycleStages::control(const RobotState& robot, const Moved& moved,
                                    CommandFrame& command) noexcept {
  TrackingReport report;
  command.enable = safety::is_powered(state_.supervisor.state);
  command.dq_p = moved.dq_p;
  const ReferenceState& next = state_.rendering.reference;
  if (command.enable) {
    control_.step(moved.reference, next, robot, state_.control, command, report);
  } else {
    control_.rest(next, state_.control, command);
    command.dq_p.setZero();
  }
  return report;
}

// Contact with the arm pushes twin and gantry from the next cycle on. Detection needs joint torques
// and is active while the law moves the arm. During a stop caused by the contact the arm yields in
// the first third of the stop time, faded out within 50 ms to leave time for braking; during any
// other stop it does not.
TouchReport CycleStages::feel_touch(bool is_on, const RobotState& robot) noexcept {
  const safety::SupervisorState& supervisor = state_.supervisor;
  constexpr double kFade = 0.05;  // s
  double share = 1.0;
  if (supervisor.mode() == Mode::kStopping) {
    const int left =
        safety::samples_of(config_.monitor.stop_time, dt_) / 3 - supervisor.stop_samples;
    const bool is_stopped_by_it = supervisor.fault.code == FaultCode::kTorqueUnexplained;
    share = is_stopped_by_it ? std::clamp(left * dt_ / kFade, 0.0, 1.0) : 0.0;
  }
  const bool gives_way =
      share > 0.0 && is_moving(supervisor.mode()) && state_.motion != Motion::kBrakeJoints;
  compliance::ComplianceState& touch = state_.touch;
  const VectorM& dq = robot.dq_m;
  const bool is_known = torque_max_.size() == dq.size() && dq.size() > 0;
  if (!config_.compliance.is_on || !is_on || !gives_way || !is_known) {
    touch = {};
    state_.rendering.touch.setZero();
    return {};
  }
  TouchReport report;
  if (touch.dq.size() == dq.size()) {
    const tracking::JointControl::JointTorques torques =
        control_.joint_torques(robot, (dq - touch.dq) / dt_);
    report = compliance::react_to_contact(torque_max_, dt_,
                                          {.torque = torques.external,
                                           .load = torques.motion,
                                           .J = rendering_.handle_jacobian(),
                                           .n_p = static_cast<int>(robot.q_p.size())},
                                          touch);
  }
  touch.dq = dq;
  state_.rendering.touch = share * report.wrench;
  return report;
}

// Last check of the command. Returns which of its entries were changed.
std::uint32_t CycleStages::sanitise(const RobotState& robot, CommandFrame& command) noexcept {
  const safety::Sanitised sanitised = sanitiser_.step(
      {.robot = robot, .was_on = state_.was_on, .q_before = state_.q_m, .tau_before = state_.tau_m},
      command);
  if (sanitised.fault.code != FaultCode::kNone) {
    safety::break_rule(sanitised.fault, state_.supervisor);
  }
  return sanitised.changed;
}

// What the next cycle needs of the command.
void CycleStages::remember(std::uint64_t sequence, const CommandFrame& command) noexcept {
  state_.dq_p = command.dq_p;
  state_.q_m = command.q_m;
  state_.tau_m = command.tau_m;
  state_.was_on = command.enable;
  state_.next_sequence = sequence + 1;
  ++state_.cycle;
}

// Writes all fields of the record. Nothing reads it in this cycle or a later one.
void CycleStages::fill(const Results& results, const Fault& warning, const TrackingReport& tracking,
                       const TouchReport& touch, std::uint32_t sanitised,
                       CycleRecord& record) const noexcept {
  std::destroy_at(&record);  // rebuilt in place: an assignment would copy all of it once more
  if (results.motion == Motion::kNone) {
    ::new (&record) CycleRecord;
  } else {
    ::new (&record) CycleRecord{results.law};
  }
  record.cycle = state_.cycle - 1;
  record.time_s = static_cast<double>(record.cycle) * dt_;
  // supervisor, after all rules of this cycle
  const safety::SupervisorState& supervisor = state_.supervisor;
  record.mode = supervisor.mode();
  record.is_autonomous = supervisor.state == safety::SafetyState::kAutonomous;
  record.stop = supervisor.stop;
  record.fault = supervisor.fault;
  record.warning = supervisor.also.code != FaultCode::kNone ? supervisor.also : warning;
  record.refusal = results.supervision.refusal;
  record.change = results.supervision.change;
  // estimation
  record.robot = results.robot;
  record.tare = state_.estimation.wrench.tare.status;
  record.is_tared = estimation_.is_tared(state_.estimation);
  record.rest = {state_.estimation.rest.is_untouched, state_.estimation.rest.zero};
  if (results.motion != Motion::kNone && estimation_.has_units()) {
    record.inertial = estimation_.inertial_report(state_.estimation);
  }
  record.collision = results.collision;
  record.q_p_target = results.gantry.command.q_target;
  // rendering
  record.passivity = results.passivity;
  record.reference = results.moved.reference;
  record.twin = results.moved.twin;
  record.sync_error = results.moved.sync_error;
  // control and sanitiser
  record.tracking = tracking;
  record.tracking.is_clamped = results.pulled_back.size() > 0;
  record.is_latency_known = control_.is_latency_known(state_.control);
  record.touch = touch;
  record.sanitised = sanitised;
  record.state_hash = hash_of(state_, rendering_.problem().rows());
}

}  // namespace hg::controller

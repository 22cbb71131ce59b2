#include "hg/cycle/cycle.h"

#include <algorithm>

#include "hg/cycle/state_hash.h"

namespace hg::cycle {
namespace {

constexpr double kBrakingRate = 20.0;  // 1/s: stopping takes about 0.2 s
constexpr double kStandstill = 1e-3;   // rad/s and m/s
constexpr double kRamp = 0.3;          // s in which the forces of a run come in

bool stands_still(const CycleRecord& record) noexcept {
  return record.twin.dq_a.lpNorm<Eigen::Infinity>() < kStandstill &&
         record.reference.dq_m.lpNorm<Eigen::Infinity>() < kStandstill &&
         record.robot.dq_p.lpNorm<Eigen::Infinity>() < kStandstill;
}

bool is_enabled(Mode mode) noexcept {
  return mode == Mode::kArmed || mode == Mode::kRunning || mode == Mode::kStopping;
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

}  // namespace

Cycle::Cycle(const Config& config, const rendering::DeviceModel& device,
             const rendering::TwinModel& twin)
    : config_(config),
      estimation_(config.estimation, device.chain, device.n_p, device.n_m, device.handle),
      rendering_(device, twin, config.rendering),
      control_(config.control, device.chain, device.n_p, device.n_m, device.handle),
      gantry_target_(target_of(config.prepositioning, device), device.chain) {
  config_.monitor.has_imu = config.estimation.wrench.has_imu;
  prepositioning::check(config_.prepositioning);
  state_.rendering = rendering_.start(VectorM::Zero(device.n_m));
  state_.control = control_.start();
  state_.dq_p = VectorP::Zero(device.n_p);
}

void Cycle::step(const SensorFrame& sensors, const OperatorFrame& operator_input,
                 CommandFrame& command, CycleRecord& record) noexcept {
  record = {};
  record.cycle = state_.cycle;
  record.time_s = static_cast<double>(state_.cycle) * config_.rendering.dt;

  // supervisor: may this sample be used, and what is the device allowed to do
  if (state_.cycle == 0) state_.next_sequence = sensors.sequence;
  supervise(sensors, operator_input.request, record);

  record.change = rendering_.change(operator_input.change, state_.rendering);
  ended_(Stage::kSupervision);

  // estimation -> rendering -> prepositioning
  if (safety::is_finite(config_.monitor, sensors)) {
    record.robot =
        estimation_.step(sensors, state_.dq_p, state_.rendering.reference.ddq_m, state_.estimation);
    ended_(Stage::kEstimation);
    const Mode mode = state_.supervisor.mode;
    if (mode == Mode::kRunning || mode == Mode::kStopping) {
      render(record);
    } else {
      hold(record);
    }
  }

  // control -> sanitiser
  write_command(sensors, operator_input, command, record);
  ended_(Stage::kControl);
  const Fault fault = safety::sanitise(config_.monitor, command);
  if (fault.code != FaultCode::kNone) stop_with(fault);
  ended_(Stage::kSafety);

  state_.dq_p = command.dq_p;
  state_.next_sequence = sensors.sequence + 1;
  ++state_.cycle;
  record.mode = state_.supervisor.mode;
  record.fault = state_.supervisor.fault;
  record.tare = state_.estimation.wrench.tare.status;
  record.is_tared = estimation_.is_tared(state_.estimation);
  record.is_latency_known = control_.is_latency_known(state_.control);
  record.state_hash = hash_of(state_, record.robot, rendering_.problem().rows());
  ended_(Stage::kStateHash);
}

void Cycle::watch(const StageProbe& probe) noexcept {
  ended_ = probe;
  rendering_.watch(probe);
}

void Cycle::supervise(const SensorFrame& sensors, ModeRequest request,
                      CycleRecord& record) noexcept {
  safety::SupervisorState& supervisor = state_.supervisor;
  const bool is_new = request != supervisor.last_request;
  const Fault fault = check(sensors);
  const bool is_arming = is_new && request == ModeRequest::kArm && supervisor.mode == Mode::kReady;
  if (is_arming) record.refusal = refusal_to_arm();

  const bool is_refused = record.refusal != Refusal::kNone;
  const bool was_fault = supervisor.mode == Mode::kFault;
  safety::advance(supervisor, is_refused ? ModeRequest::kNone : request, is_held(sensors), fault);
  supervisor.last_request = request;
  if (was_fault && supervisor.mode != Mode::kFault) begin_anew();

  const bool is_at_rest = supervisor.mode != Mode::kRunning && supervisor.mode != Mode::kStopping;
  estimation_.tare(is_new && request == ModeRequest::kTare, is_at_rest, state_.estimation);
}

Fault Cycle::check(const SensorFrame& sensors) noexcept {
  const Fault fault = safety::check_sensors(config_.monitor, sensors, state_.next_sequence);
  if (fault.code != FaultCode::kNone) return fault;
  const bool is_on = is_enabled(state_.supervisor.mode);
  control_.listen(sensors, is_on, state_.control);
  return is_on ? control_.check_latency(sensors, state_.control) : Fault{};
}

Refusal Cycle::refusal_to_arm() const noexcept {
  if (!estimation_.is_tared(state_.estimation)) return Refusal::kNotTared;
  if (!control_.is_latency_known(state_.control)) return Refusal::kLatencyUnknown;
  if (!control_.is_stable(state_.control)) return Refusal::kLatencyTooLong;
  return Refusal::kNone;
}

// Whatever a fault has left in estimation and control goes; what was measured at rest stays.
void Cycle::begin_anew() noexcept {
  const estimation::TareState tare = state_.estimation.wrench.tare;
  state_.estimation = {};
  state_.estimation.wrench.tare = tare;
  control_.restart(state_.control);
}

// Nothing moves. Before it is armed the device may be moved by others: the twin goes along.
void Cycle::hold(CycleRecord& record) noexcept {
  rendering::State& rendering = state_.rendering;
  if (state_.supervisor.mode != Mode::kArmed) {
    rendering.reference.q_m = record.robot.q_m;
    rendering_.align(record.robot, rendering);
  }
  rendering.reference.dq_m.setZero();
  rendering.twin.dq_a.setZero();
  rendering_.step(rendering, kBrakingRate, record);
  rendering.reference.ddq_m.setZero();
  rendering.twin.ddq_a.setZero();
  record.reference = rendering.reference;
  record.twin = rendering.twin;
  state_.dq_p.setZero();
  state_.is_blocked = false;
  state_.force_share = 0.0;
}

void Cycle::render(CycleRecord& record) noexcept {
  const bool is_stopping = state_.supervisor.mode == Mode::kStopping;
  const bool has_left =
      rendering_.stay_near(record.robot, config_.control.error_max, state_.rendering);
  rendering_.step(state_.rendering, is_stopping ? kBrakingRate : 0.0, record, state_.force_share);
  state_.force_share = std::min(1.0, state_.force_share + config_.rendering.dt / kRamp);

  const Fault fault = safety::check_reference(config_.monitor, record);
  if (fault.code != FaultCode::kNone) {
    stop_with(fault);
    return;
  }
  const VectorP q_p_target =
      gantry_target_.step(record.robot, state_.rendering.reference.q_m, state_.gantry_target);
  const prepositioning::Command gantry =
      prepositioning::step(config_.prepositioning, record.robot, q_p_target, state_.is_blocked);
  record.q_p_target = gantry.q_target;
  state_.dq_p = is_stopping ? VectorP::Zero(gantry.dq.size()) : gantry.dq;
  state_.is_blocked = rendering_.is_blocked();
  record.tracking.is_clamped = has_left;
  ended_(Stage::kPrepositioning);
  rendering_.integrate(state_.rendering);
  if (is_stopping && stands_still(record)) safety::has_stopped(state_.supervisor);
  ended_(Stage::kIntegration);
}

void Cycle::stop_with(const Fault& fault) noexcept {
  safety::advance(state_.supervisor, state_.supervisor.last_request, false, fault);
}

void Cycle::write_command(const SensorFrame& sensors, const OperatorFrame& operator_input,
                          CommandFrame& command, CycleRecord& record) noexcept {
  const Mode mode = state_.supervisor.mode;
  command.sequence = sensors.sequence;
  command.enable = is_enabled(mode);
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

}  // namespace hg::cycle

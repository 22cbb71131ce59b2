#include "hg/device/franka/franka_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"
#include "hg/device/franka/velocity.h"

namespace hg::franka {
namespace {

constexpr std::uint64_t kStartPatience = 1000;  // states until a motion has begun
constexpr std::uint64_t kEndPatience = 300;     // states until a motion has ended, then StopMove
constexpr std::uint64_t kOvertaken = 100;       // states that may be older than an answer
constexpr std::uint64_t kCyclesOfRate = 100;    // over which the robot takes its success rate
constexpr std::int64_t kLook = 5'000'000;       // ns between looks at the stream
constexpr double kCloseTime = 0.5;              // s
constexpr double kLoadTime = 3.0;               // s until enough states show the load
constexpr double kNoSpeed = 1e-4;               // rad/s
constexpr double kLittleAcceleration = 3.0;     // rad/s^2, may vanish in one period
constexpr double kSameMass = 1e-3;              // kg
constexpr double kGravity = 9.81;               // m/s^2

constexpr double kApproachSpeed = 0.2;  // rad/s on the way to a start
constexpr double kTopSpeed = 1.875;     // of an approach, times its mean
constexpr double kSettling = 0.5;       // s after an approach

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

// Minimum jerk from 0 to 1 in one unit of time.
struct Approach {
  double way = 0.0, speed = 0.0, acceleration = 0.0;
};

Approach approach(double s) noexcept {
  return {.way = s * s * s * (10.0 + s * (-15.0 + 6.0 * s)),
          .speed = 30.0 * s * s * (1.0 - s) * (1.0 - s),
          .acceleration = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)};
}

CollisionRequest request_of(const CollisionThresholds& thresholds) {
  return {.lower_torque_accelerating = thresholds.torque,
          .upper_torque_accelerating = thresholds.torque,
          .lower_torque = thresholds.torque,
          .upper_torque = thresholds.torque,
          .lower_force_accelerating = thresholds.force,
          .upper_force_accelerating = thresholds.force,
          .lower_force = thresholds.force,
          .upper_force = thresholds.force};
}

// Whether a state may be older than the last answer by TCP, which overtakes states by UDP. It came
// when `answered_at` was the newest state; 0: none came.
bool may_be_older(std::uint64_t state, std::uint64_t answered_at) noexcept {
  return answered_at > 0 && state <= answered_at + kOvertaken;
}

bool is_finite(const CommandFrame& command) noexcept {
  const Eigen::Index n = kJoints;
  return command.q_m.size() == n && command.dq_m.size() == n && command.ddq_m.size() == n &&
         command.q_m.allFinite() && command.dq_m.allFinite() && command.ddq_m.allFinite();
}

}  // namespace

FrankaDevice::FrankaDevice(const FrankaConfig& config, const model::ChainModel& chain)
    : config_(config), session_(config.address, config.timeouts), impedance_(chain, config.gains) {
  if (chain.nv() != kJoints) {
    throw SetupError(
        fmt::format("{}: a Franka has 7 joints, this device {}", session_.at(), chain.nv()));
  }
  await_idle();
  set_collision(config_.collision);
  check_at_rest();
  check_signs(chain);
}

FrankaDevice::~FrankaDevice() { close(fault_); }

void FrankaDevice::set_collision(const CollisionThresholds& thresholds) {
  session_.ask(Command::kSetCollisionBehavior, request_of(thresholds), "collision thresholds");
}

// Recovers from what has stopped the robot before this connection.
void FrankaDevice::await_idle() {
  const std::int64_t deadline = now_ns() + ns(config_.timeouts.first_state_s);
  bool has_state = false;
  while (!has_state && now_ns() < deadline) {
    session_.wait(deadline);
    while (session_.receive(state_)) has_state = true;
  }
  if (!has_state) throw SetupError(session_.at() + ": the robot sends no states any more");
  if (state_.robot_mode == RobotMode::kReflex) {
    session_.ask(Command::kAutomaticErrorRecovery,
                 fmt::format("recovery from {}", to_string(errors_of(state_))));
    return;
  }
  if (state_.robot_mode == RobotMode::kIdle) return;
  throw SetupError(
      fmt::format("{}: the robot must be idle, it is in mode '{}': release the user stop, end "
                  "guiding and other programs",
                  session_.at(), to_string(state_.robot_mode)));
}

// The robot's estimates at rest, with this load.
RestingEstimate FrankaDevice::estimate_with(const LoadRequest& load) {
  session_.ask(Command::kSetLoad, load, "load");
  RestingEstimate estimate;
  const double mass = load.mass;
  const int needed = static_cast<int>(std::lround(config_.rest_s / kPeriod_s));
  int to_settle = static_cast<int>(std::lround(config_.settle_s / kPeriod_s));
  const std::int64_t deadline = now_ns() + ns(config_.rest_s + config_.settle_s + kLoadTime);
  while (estimate.states < needed && now_ns() < deadline) {
    session_.wait(deadline);
    while (session_.receive(state_)) {
      const float shown = state_.m_load;
      if (std::abs(shown - mass) > kSameMass || to_settle-- > 0) continue;
      estimate.add(state_, config_.T_F_S);
    }
  }
  if (estimate.states < needed) {
    const float shown = state_.m_load;
    throw SetupError(fmt::format("{}: the robot was given a load of {:g} kg and shows {:g} kg",
                                 session_.at(), mass, shown));
  }
  estimate.finish();
  return estimate;
}

void FrankaDevice::check_at_rest() {
  const RestingEstimate estimate = estimate_with(config_.load);
  const std::string why = objection(estimate, impedance_.weight(estimate.q));
  if (!why.empty()) throw SetupError(session_.at() + ": " + why);
  resting_ = estimate.w_S;
}

// Without its load the robot takes the tool for a hand that pulls down, whatever its friction.
void FrankaDevice::check_signs(const model::ChainModel& chain) {
  const double mass = config_.load.mass;
  const RestingEstimate without = estimate_with(LoadRequest{});
  const RestingEstimate with = estimate_with(config_.load);
  model::ChainData arm(chain);
  arm.update_poses(with.q);
  const Eigen::Matrix3d R_B_S = arm.pose(chain.frame(config_.flange)).R * config_.T_F_S.R;
  const Eigen::Vector3d weight = R_B_S.transpose() * Eigen::Vector3d(0.0, 0.0, -kGravity * mass);
  const Eigen::Vector3d seen = without.w_S.head<3>() - with.w_S.head<3>();
  const SignCheck check = check_weight(seen, weight);
  if (check == SignCheck::kWrong) {
    throw SetupError(fmt::format(
        "{}: the weight of the tool, {:.1f} N, appears in the robot's estimate as ({:.1f}, {:.1f}, "
        "{:.1f}) N at the flange, expected is ({:.1f}, {:.1f}, {:.1f}) N: sign or frame of the "
        "estimate differ from what this driver assumes",
        session_.at(), weight.norm(), seen.x(), seen.y(), seen.z(), weight.x(), weight.y(),
        weight.z()));
  }
  has_checked_signs_ = check == SignCheck::kRight;
}

void FrankaDevice::move_to(const VectorM& goal) {
  set_collision(kLightTouch);
  lead_to(goal);
  await_end_of_motion();
  set_collision(config_.collision);
  check_at_rest();
  // a new run begins
  queue_ = {};
  is_started_ = false;
  first_id_ = 0;
}

void FrankaDevice::lead_to(const VectorM& goal) {
  SensorFrame sensors;
  read(sensors);
  const VectorM from = sensors.q_m, way = goal - from;
  const double duration = std::max(1.0, kTopSpeed * way.cwiseAbs().maxCoeff() / kApproachSpeed);
  double begin = -1.0;  // until the motion has begun
  CommandFrame command;
  command.enable = true;
  while (true) {
    if (sensors.driver_fault != FaultCode::kNone || sensors.safety.emergency_stop) {
      throw SetupError(fmt::format("{}: the robot has stopped on its way to the start: {}",
                                   session_.at(), stop_words(sensors)));
    }
    if (begin < 0.0 && phase_ == Phase::kMoving) begin = sensors.time_s;
    const double since = begin < 0.0 ? 0.0 : sensors.time_s - begin;
    if (since > duration + kSettling) return;
    const Approach at = approach(std::min(since / duration, 1.0));
    command.sequence = sensors.sequence;
    command.q_m = from + at.way * way;
    command.dq_m = at.speed / duration * way;
    command.ddq_m = at.acceleration / (duration * duration) * way;
    write(command);
    read(sensors);
  }
}

std::string FrankaDevice::stop_words(const SensorFrame& sensors) const {
  if (sensors.safety.emergency_stop) return "the user stop is pressed";
  const std::string words = farewell();
  return words.empty() ? std::string(to_string(sensors.driver_fault)) : words;
}

void FrankaDevice::read(SensorFrame& sensors) noexcept {
  arrived_ns_ = late_ns_ = 0;
  if (fault_ != FaultCode::kNone) return stop(fault_, sensors);
  if (!is_started_) skip_old_states();
  const std::int64_t begin = now_ns();
  const std::int64_t deadline = begin + ns(config_.state_timeout_s);
  while (true) {
    take_in();
    if (session_.is_closed()) return stop(FaultCode::kDeviceGone, sensors);
    if (queue_.pop(sensors)) {
      sensors.driver_fault = driver_fault();
      late_ns_ = now_ns() - std::max(begin, arrived_ns_);
      return;
    }
    const std::int64_t now = now_ns();
    if (now >= deadline) return stop(FaultCode::kDeviceSilent, sensors);
    session_.wait(std::min(now + kLook, deadline));
  }
}

// What has come between set-up and the first read.
void FrankaDevice::skip_old_states() noexcept {
  while (session_.receive(state_)) {
  }
  is_started_ = true;
}

void FrankaDevice::take_in() noexcept {
  take_answers();
  RobotState state;
  while (!queue_.is_full() && session_.receive(state)) take(state);
}

void FrankaDevice::take(const RobotState& state) noexcept {
  const std::uint64_t id = state.message_id, before = state_.message_id;
  if (first_id_ == 0) {
    first_id_ = id;
  } else if (id > before) {
    own_.lost += id - before - 1;
  } else {
    ++(id == before ? own_.duplicate : own_.reordered);
  }
  ++own_.received;
  arrived_.sequence = id;
  arrived_.time_s = kPeriod_s * static_cast<double>(id - first_id_);
  arrived_.q_m = joints_of(state.q);
  arrived_.dq_m = joints_of(state.dq);
  arrived_.w_S = user_wrench(state, config_.T_F_S) - resting_;
  arrived_.dead_man = true;  // the arm has none
  arrived_.safety.emergency_stop = state.robot_mode == RobotMode::kUserStopped;
  if (!queue_.push(arrived_)) {
    ++own_.late;
  } else if (arrived_ns_ == 0) {
    arrived_ns_ = session_.arrived_ns();
  }
  if (id <= before) return;
  state_ = state;
  follow(state);
}

void FrankaDevice::take_answers() noexcept {
  Answer answer;
  while (session_.receive(answer)) {
    if (answer.header.id == recovery_id_) {
      recovery_id_ = 0;
      recovery_status_ = answer.status;
      if (answer.status == 0) forget_faults();
    }
    if (answer.header.id != move_id_) continue;
    const auto status = static_cast<MoveStatus>(answer.status);
    if (status == MoveStatus::kMotionStarted) continue;
    move_id_ = 0;
    if (status == MoveStatus::kSuccess || answer.header.id == ended_id_) continue;
    const bool is_stopped = state_.robot_mode == RobotMode::kUserStopped;
    if (status == MoveStatus::kEmergencyAborted || is_stopped) {
      phase_ = Phase::kIdle;  // the user stop is an input of safety, no fault of the drives
      stopped_at_ = state_.message_id;
      continue;
    }
    move_status_ = status;
    // a reflex shows in the next states, with its reasons
    if (status != MoveStatus::kReflexAborted) abort(state_);
  }
}

// The phase of the motion by what the robot says of itself.
void FrankaDevice::follow(const RobotState& state) noexcept {
  const std::uint64_t id = state.message_id;
  const bool has_motion = is_driven(state);
  if (state.robot_mode == RobotMode::kUserStopped) {
    phase_ = Phase::kIdle;
    return;
  }
  if (state.robot_mode == RobotMode::kReflex) {
    if (!may_be_older(id, recovered_at_)) abort(state);
    return;
  }
  switch (phase_) {
    case Phase::kIdle:
      return;
    case Phase::kStarting:
      if (has_motion) {
        phase_ = Phase::kMoving;
        counted_to_ = id;
      }
      if (id - phase_since_ > kStartPatience) abort(state);
      return;
    case Phase::kMoving:
      if (!has_motion) return abort(state);
      count_unanswered(state);
      return;
    case Phase::kFinishing:
      if (!has_motion) phase_ = Phase::kIdle;
      return;
  }
}

// The robot reports the share of the last 100 cycles that were answered in time.
void FrankaDevice::count_unanswered(const RobotState& state) noexcept {
  const float answered = state.control_command_success_rate;
  if (state.message_id - counted_to_ < kCyclesOfRate) return;
  counted_to_ = state.message_id;
  if (answered >= 0.0F && answered <= 1.0F) {
    unanswered_ += std::lround(kCyclesOfRate * (1.0F - answered));
  }
}

void FrankaDevice::abort(const RobotState& state) noexcept {
  is_aborted_ = true;
  errors_ |= errors_of(state);
  phase_ = Phase::kIdle;
}

FaultCode FrankaDevice::driver_fault() const noexcept {
  if (was_not_finite_) return FaultCode::kCommandNotFinite;
  if (!is_aborted_) return FaultCode::kNone;
  return errors_[kCommunicationError] ? FaultCode::kCommandsLost : FaultCode::kDriveFault;
}

void FrankaDevice::stop(FaultCode fault, SensorFrame& sensors) noexcept {
  fault_ = fault;
  if (sensors.q_m.size() != kJoints) {
    sensors.q_m = joints_of(state_.q);
    sensors.dq_m = VectorM::Zero(kJoints);
  }
  ++sensors.sequence;
  sensors.driver_fault = fault;
}

void FrankaDevice::write(const CommandFrame& command) noexcept {
  if (command.panel.reset && !was_reset_) recover();
  was_reset_ = command.panel.reset;
  if (!command.enable || is_aborted_ || fault_ != FaultCode::kNone) return finish_motion();
  if (!is_finite(command)) {
    was_not_finite_ = true;
    return finish_motion();
  }
  const bool is_stopped =
      state_.robot_mode == RobotMode::kUserStopped || may_be_older(state_.message_id, stopped_at_);
  if (phase_ == Phase::kIdle && !was_not_finite_ && !is_stopped) start_motion();
  if (phase_ != Phase::kMoving) return;
  if (command.sequence != state_.message_id) {
    ++own_.late;  // an answer to an older state does not count for the robot
    return;
  }
  config_.interface == Interface::kTorques ? send_torques(command) : send_speeds(command);
}

bool FrankaDevice::is_driven(const RobotState& state) const noexcept {
  if (config_.interface == Interface::kTorques) {
    return state.controller_mode == kExternalController &&
           state.motion_generator_mode == kStateWithoutGenerator;
  }
  return state.controller_mode == kJointImpedance &&
         state.motion_generator_mode == kStateByJointVelocity;
}

void FrankaDevice::start_motion() noexcept {
  move_status_ = MoveStatus::kSuccess;
  errors_.reset();
  MoveRequest request;
  if (config_.interface == Interface::kSpeeds) {
    request.controller_mode = kJointImpedance;
    request.motion_generator_mode = kMoveByJointVelocity;
  }
  move_id_ = session_.send(Command::kMove, request);
  phase_ = Phase::kStarting;
  phase_since_ = state_.message_id;
}

void FrankaDevice::send_torques(const CommandFrame& command) noexcept {
  const VectorM wanted = impedance_.torques(command, joints_of(state_.q), joints_of(state_.dq));
  const VectorM tau = rate_limited(wanted, joints_of(state_.tau_J_d));
  if (!tau.allFinite()) return;  // the state was not finite
  command_.message_id = state_.message_id;
  std::array<double, kJoints> values;
  Eigen::Map<Eigen::Matrix<double, kJoints, 1>>(values.data()) = tau;
  command_.tau_J_d = values;
  command_.torque_command_finished = 0;
  session_.send(command_);
  ++own_.sent;
}

void FrankaDevice::send_speeds(const CommandFrame& command) noexcept {
  send_speeds(led_speeds(command, joints_of(state_.q)));
}

void FrankaDevice::send_speeds(const VectorM& wanted) noexcept {
  const VectorM speeds = limited_speeds(wanted, joints_of(state_.q_d), joints_of(state_.dq_d),
                                        joints_of(state_.ddq_d));
  if (!speeds.allFinite()) return;  // the state was not finite
  command_.message_id = state_.message_id;
  std::array<double, kJoints> values;
  Eigen::Map<Eigen::Matrix<double, kJoints, 1>>(values.data()) = speeds;
  command_.dq_c = values;
  command_.motion_generation_finished = 0;
  session_.send(command_);
  ++own_.sent;
}

// Whether the joints have come to rest, so that the motion may end.
bool FrankaDevice::has_braked() const noexcept {
  return config_.interface == Interface::kTorques ||
         (joints_of(state_.dq_d).cwiseAbs().maxCoeff() < kNoSpeed &&
          joints_of(state_.ddq_d).cwiseAbs().maxCoeff() < kLittleAcceleration);
}

// Brakes, then says that the motion is over until the robot has ended the motion; the robot then
// holds itself.
void FrankaDevice::finish_motion() noexcept {
  if (phase_ == Phase::kIdle) return;
  const std::uint64_t id = state_.message_id;
  if (phase_ != Phase::kFinishing) {
    if (phase_ == Phase::kStarting) session_.send(Command::kStopMove, {});
    phase_ = Phase::kFinishing;
    phase_since_ = id;
    ended_id_ = move_id_;
  } else if (id - phase_since_ == kEndPatience) {
    session_.send(Command::kStopMove, {});
  }
  if (command_.message_id == id) return;  // a second answer would come too late for its cycle
  if (!has_braked()) return send_speeds(VectorM(VectorM::Zero(kJoints)));
  command_.message_id = id;
  command_.dq_c = {};
  const bool has_torques = config_.interface == Interface::kTorques;
  (has_torques ? command_.torque_command_finished : command_.motion_generation_finished) = 1;
  session_.send(command_);
  ++own_.sent;
}

void FrankaDevice::recover() noexcept {
  if (fault_ != FaultCode::kNone || recovery_id_ != 0) return;
  if (state_.robot_mode == RobotMode::kReflex) {
    recovery_id_ = session_.send(Command::kAutomaticErrorRecovery, {});
  } else {
    forget_faults();
  }
}

void FrankaDevice::forget_faults() noexcept {
  is_aborted_ = was_not_finite_ = false;
  errors_.reset();
  move_status_ = MoveStatus::kSuccess;
  recovered_at_ = state_.message_id;
}

void FrankaDevice::close(FaultCode) noexcept {
  if (is_closed_) return;
  is_closed_ = true;
  await_end_of_motion();
  if (phase_ != Phase::kIdle) session_.send(Command::kStopMove, {});
}

void FrankaDevice::await_end_of_motion() noexcept {
  const std::int64_t deadline = now_ns() + ns(kCloseTime);
  SensorFrame ignored;
  while (phase_ != Phase::kIdle && now_ns() < deadline && !session_.is_closed()) {
    finish_motion();
    session_.wait(std::min(now_ns() + ns(kPeriod_s), deadline));
    take_in();
    while (queue_.pop(ignored)) {
    }
  }
}

std::string FrankaDevice::farewell() const {
  if (was_not_finite_) return "a command that is not finite was not sent to the robot";
  if (!is_aborted_) return "";
  std::string words = fmt::format("robot in mode '{}'", to_string(state_.robot_mode));
  if (errors_.any()) words += ": " + to_string(errors_);
  if (move_status_ != MoveStatus::kSuccess) {
    words += fmt::format("; motion {}", to_string(move_status_));
  }
  if (recovery_status_ != 0) {
    words += "; recovery " + answer_words(Command::kAutomaticErrorRecovery, recovery_status_);
  }
  return words;
}

LinkCounts FrankaDevice::counts() const noexcept {
  LinkCounts counts = own_;
  counts.held = queue_.held();
  counts.late = std::max(own_.late, unanswered_);
  counts.foreign = session_.foreign();
  return counts;
}

}  // namespace hg::franka

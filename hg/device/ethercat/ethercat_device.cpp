#include "hg/device/ethercat/ethercat_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"
#include "hg/core/monotonic_clock.h"
#include "hg/device/ethercat/bus_check.h"
#include "hg/device/ethercat/bus_registers.h"
#include "hg/device/ethercat/master.h"

namespace hg::ethercat {
namespace {

constexpr std::uint32_t kSilent = 10;                // exchanges without an answer in a row
constexpr std::uint32_t kNoticed = 3;                // exchanges that are not complete, as rule 109
constexpr std::uint32_t kIgnored = 3;                // samples in which a drive does not follow
constexpr int kStartCycles = 1000;                   // until all drives are without fault
constexpr int kStepCycles = 5000;                    // until frames are in step with the clocks
constexpr int kCallCycles = 200;                     // between two calls to OP
constexpr int kRecoveryCycles = 500;                 // until all slaves and drives are well again
constexpr int kStopCycles = 200;                     // until no drive has power
constexpr int kEndCycles = 20;                       // until all drives are off
constexpr int kClockCycles = 10;                     // between two looks at them
constexpr std::int64_t kClockPause_ns = 20'000'000;  // the same, of exchanges without a period
constexpr int kPulseLooks = 50;                  // until sync pulses come and clocks are together
constexpr std::int64_t kClocksApart = 20;        // most, share of a period
constexpr double kEnabling = 2.0;                // s until drives follow, with slow brakes
constexpr std::uint32_t kStatusPatience = 2000;  // us, once, for the reason of a fault
constexpr std::uint32_t kClosePatience = 5000;   // us

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }
std::uint32_t us(double seconds) noexcept {
  return static_cast<std::uint32_t>(std::llround(1e6 * seconds));
}

}  // namespace

EthercatDevice::EthercatDevice(const EthercatConfig& config)
    : EthercatDevice(config, std::make_unique<Master>(config.interface_name)) {}

EthercatDevice::EthercatDevice(const EthercatConfig& config, std::unique_ptr<Bus> bus)
    : config_(config),
      bus_(std::move(bus)),
      patience_us_(us(config.machine.answer_s)),
      period_ns_(ns(1.0 / config.rate_Hz)),
      pace_(now_ns(), period_ns_) {
  found_ = bus_->scan();
  const std::vector<std::string> sentences = differences(*bus_, found_, config_.machine);
  if (!sentences.empty()) {
    throw SetupError(fmt::format("{}: the bus is not {}:\n{}", config_.interface_name,
                                 config_.machine.name, fmt::join(sentences, "\n")));
  }
  start();
  if (!come_into_step()) {
    throw SetupError(fmt::format(
        "{}: frames do not come into step with the clocks of the slaves, the last one was {} us "
        "off: is this computer busy, or not real-time (hapticgiant doctor)?",
        config_.interface_name, pace_.error_ns() / 1000));
  }
  check_pulses();
  bus_->operate(found_.size(), [&] { wait_for_turn(); });
  await_drives();
  rest();
}

EthercatDevice::~EthercatDevice() { close(fault_); }

// To SAFE-OP, with all buffers.
void EthercatDevice::start() {
  const std::vector<Slave>& slaves = config_.machine.slaves;
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    if (slaves[i].is_synchronous) bus_->use_sync(i);
  }
  const std::uint32_t watchdog_ms = us(config_.machine.watchdog_s) / 1000;
  expected_ = bus_->start(watchdog_ms, static_cast<std::uint32_t>(period_ns_));
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    const auto [outputs, inputs] = bus_->sizes(i);
    const std::size_t bytes_out = bits_of(slaves[i].outputs) / 8;
    const std::size_t bytes_in = bits_of(slaves[i].inputs) / 8;
    if (outputs != bytes_out || inputs != bytes_in) {
      throw SetupError(
          fmt::format("{}: has {} bytes of outputs and {} of inputs, expected are {} and {}",
                      slave_name(config_.machine, i), outputs, inputs, bytes_out, bytes_in));
    }
    stations_.push_back({.outputs = std::vector<std::uint8_t>(bytes_out),
                         .inputs = std::vector<std::uint8_t>(bytes_in)});
  }
  const std::vector<std::string> sentences = watchdog_faults(*bus_, config_.machine);
  if (!sentences.empty()) throw SetupError(fmt::format("{}", fmt::join(sentences, "\n")));
  watches_.resize(slaves.size());
  hold_cycles_ =
      static_cast<std::uint32_t>(std::ceil(config_.machine.brake_closing_s * config_.rate_Hz));
  for (const Slave& slave : slaves) {
    for (const Entry<Output>& entry : slave.outputs) {
      has_brake_outputs_ = has_brake_outputs_ || entry.meaning == Output::kOpenBrakes;
    }
  }
  frame_.q_m = VectorM::Zero(config_.n_m);
  frame_.q_p = VectorP::Zero(config_.n_p);
}

bool EthercatDevice::has_pulses() const noexcept {
  return std::ranges::any_of(config_.machine.slaves, &Slave::is_synchronous);
}

// By what the slaves themselves say: sync pulses come, and clocks are together.
void EthercatDevice::check_pulses() {
  if (!has_pulses()) return;
  PulseCheck check(*bus_, config_.machine, static_cast<std::uint32_t>(period_ns_ / kClocksApart));
  std::vector<std::string> sentences;
  for (int look = 0; look < kPulseLooks; ++look) {
    for (int i = 0; i < kClockCycles; ++i) exchange();
    sentences = check.faults();
    if (sentences.empty()) return;
    if (config_.is_fast) sleep_until(now_ns() + kClockPause_ns);
  }
  throw SetupError(fmt::format("{}", fmt::join(sentences, "\n")));
}

bool EthercatDevice::is_silent() const noexcept { return lost_in_a_row_ >= kSilent; }

// Drives want their frames between the sync pulses before they go to OP. False: they are not.
bool EthercatDevice::come_into_step() noexcept {
  if (!has_pulses() || config_.machine.moves_with_frames) return true;
  pace_.restart();
  for (int i = 0; i < kStepCycles && !pace_.is_settled() && !is_silent(); ++i) exchange();
  return pace_.is_settled();
}

// Resets old faults of the drives; they stay off.
void EthercatDevice::await_drives() {
  const auto is_off = [&](std::size_t i) {
    return !is_drive(i) || state_of(stations_[i].status) == DriveState::kSwitchOnDisabled;
  };
  bool has_answer = false;
  for (int i = 0; i < kStartCycles && !is_silent(); ++i) {
    recovery_ = kStartCycles - i;
    if (exchange() != expected_) continue;
    take_in();
    has_answer = true;
    bool are_off = true;
    for (std::size_t k = 0; k < stations_.size(); ++k) are_off = are_off && is_off(k);
    if (are_off) {
      recovery_ = 0;
      return;
    }
  }
  if (!has_answer) {
    throw SetupError(config_.interface_name + ": exchanges of process data stay incomplete");
  }
  std::size_t slave = 0;
  while (is_off(slave)) ++slave;
  blame(Cause::kDrive, slave);
  throw SetupError(slave_name(config_.machine, culprit_) + ": the drive stays in " + drive_words());
}

// To SAFE-OP, where no slave waits for frames.
void EthercatDevice::rest() noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    bus_->request_state(i, kSafeOp, kStatusPatience);
  }
  exchanged_ns_ = 0;
}

// Whether read() was not called for so long that the watchdogs of the slaves may have acted, while
// drives were off.
bool EthercatDevice::has_paused() const noexcept {
  const bool is_enabled = has_command_ && command_.enable;
  return !is_enabled && now_ns() - exchanged_ns_ > ns(0.5 * config_.machine.watchdog_s);
}

// To OP again after a pause; drives stay off. A slave that does not come along is a fault.
void EthercatDevice::wake() noexcept {
  is_in_use_ = false;
  lost_in_a_row_ = 0;
  come_into_step();
  recovery_ = kStartCycles + 1;
  for (int i = 0; i < kStartCycles && recovery_ > 0 && !is_silent(); ++i) {
    const int counter = exchange();
    if (counter < 0) continue;
    take_in();
    look_at_recovery(counter);
    if (i % kCallCycles == 0) call_to_op();
  }
  recovery_ = 0;
}

void EthercatDevice::wait_for_turn() noexcept {
  if (config_.is_fast) return;
  sleep_until(pace_.due_ns());
  pace_.advance(now_ns());
}

// Waits for the next period, and exchanges process data once.
int EthercatDevice::exchange() noexcept {
  const std::int64_t turn_ns = std::max(now_ns(), pace_.due_ns());
  wait_for_turn();
  put_out();
  const std::int64_t begin_ns = now_ns();
  const int counter = bus_->exchange(patience_us_);
  exchanged_ns_ = now_ns();
  late_ns_ =
      begin_ns - turn_ns + std::max<std::int64_t>(0, exchanged_ns_ - begin_ns - patience_ns());
  lost_in_a_row_ = counter < 0 ? lost_in_a_row_ + 1 : 0;
  if (counter >= 0 && bus_->time_ns() != 0) pace_.follow(bus_->time_ns());
  return counter;
}

void EthercatDevice::read(SensorFrame& sensors) noexcept {
  ++sequence_;
  if (fault_ == FaultCode::kDeviceSilent) {
    keep_stopping();
    return repeat(sensors);
  }
  if (fault_ == FaultCode::kNone && has_paused()) wake();
  is_in_use_ = true;
  const int counter = exchange();
  ++counts_.sent;
  frame_.bus_errors = 0;
  suspect_ = Cause::kNone;
  if (counter < 0) {
    take_lost();
    return repeat(sensors);
  }
  ++counts_.received;
  if (has_command_) frame_.answered_sequence = command_.sequence;
  take_in();
  look_at_step();
  look_at_counter(counter);
  look_at_states();
  look_at_drives();
  look_at_sensors();
  look_at_bus_errors(counter);
  if (recovery_ > 0) look_at_recovery(counter);
  repeat(sensors);
}

// The last sample, as that of this period.
void EthercatDevice::repeat(SensorFrame& sensors) noexcept {
  frame_.sequence = sequence_;
  frame_.time_s = static_cast<double>(sequence_) / config_.rate_Hz;
  frame_.driver_fault = fault_;
  sensors = frame_;
}

void EthercatDevice::take_lost() noexcept {
  ++counts_.lost;
  ++counts_.held;
  if (recovery_ > 0) --recovery_;
  frame_.bus_errors = static_cast<std::uint32_t>(stations_.size());
  suspect(Cause::kIncomplete, 0);
  look_at_bus_errors(0);
  if (is_silent()) fall_silent();
}

// No answer comes, but slaves may hear.
void EthercatDevice::keep_stopping() noexcept {
  ++counts_.sent;
  if (exchange() < 0) {
    ++counts_.lost;
    return;
  }
  ++counts_.received;
  take_in();
}

void EthercatDevice::take_in() noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    bus_->get_inputs(i, stations_[i].inputs);
    take_inputs(config_.machine.slaves[i], config_.n_p, config_.n_m, stations_[i], frame_);
  }
}

// The last one counts: a working counter only says that something is wrong.
void EthercatDevice::suspect(Cause cause, std::size_t slave) noexcept {
  suspect_ = cause;
  suspected_ = slave;
}

// Outputs that come with a pulse are taken a period too late or too early.
void EthercatDevice::look_at_step() noexcept {
  if (!has_pulses() || config_.machine.moves_with_frames || pace_.is_in_step()) return;
  frame_.bus_errors = 1;
  suspect(Cause::kOutOfStep, 0);
}

void EthercatDevice::look_at_counter(int counter) noexcept {
  if (counter == expected_) return;
  frame_.bus_errors = 1;
  suspect(Cause::kIncomplete, 0);
}

// A drive that has left OP stops the machine at once; without another slave the monitor stops it
// under control.
void EthercatDevice::look_at_states() noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (bus_->state(i) == kOp) continue;
    ++frame_.bus_errors;
    if (is_drive(i)) {
      stop(Cause::kLeftOp, i, FaultCode::kDriveFault);
    } else {
      suspect(Cause::kLeftOp, i);
    }
  }
}

void EthercatDevice::look_at_drives() noexcept {
  const bool is_enabled = may_move();
  enabling_ = is_enabled ? enabling_ + 1 : 0;
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (is_drive(i)) look_at_drive(i, is_enabled);
  }
}

void EthercatDevice::look_at_drive(std::size_t slave, bool is_enabled) noexcept {
  Watch& watch = watches_[slave];
  const DriveState state = state_of(stations_[slave].status);
  if (has_failed(state)) stop(Cause::kDrive, slave, FaultCode::kDriveFault);
  const bool must_follow = is_enabled && watch.has_followed;
  if (must_follow && state != DriveState::kOperationEnabled) {
    stop(Cause::kDisabled, slave, FaultCode::kDriveFault);
  }
  const bool follows = is_following(stations_[slave].status);
  watch.ignored = must_follow && !follows ? watch.ignored + 1 : 0;
  if (watch.ignored >= kIgnored) stop(Cause::kNotFollowing, slave, FaultCode::kDriveFault);
  watch.has_followed = is_enabled && (watch.has_followed || follows);
  const bool is_overdue = enabling_ > kEnabling * config_.rate_Hz;
  if (is_overdue && !watch.has_followed) stop(Cause::kNotEnabled, slave, FaultCode::kDriveFault);
}

void EthercatDevice::look_at_sensors() noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (is_drive(i) || bus_->state(i) != kOp) continue;
    const Station& station = stations_[i];
    if (station.has_new_samples && station.error == 0) continue;
    ++frame_.bus_errors;
    suspect(station.error != 0 ? Cause::kSensor : Cause::kNoSamples, i);
  }
}

// The monitor stops the machine; the cause is kept for farewell().
void EthercatDevice::look_at_bus_errors(int counter) noexcept {
  incomplete_in_a_row_ = frame_.bus_errors > 0 ? incomplete_in_a_row_ + 1 : 0;
  if (incomplete_in_a_row_ != kNoticed || cause_ != Cause::kNone) return;
  culprit_counter_ = counter;
  blame(suspect_, suspected_);
}

// While the machine recovers, look_at_recovery() decides.
void EthercatDevice::stop(Cause cause, std::size_t slave, FaultCode fault) noexcept {
  if (fault_ != FaultCode::kNone || recovery_ > 0) return;
  fault_ = fault;
  blame(cause, slave);
}

// A machine that stands with another fault keeps its cause, unless it recovers from that.
void EthercatDevice::fall_silent() noexcept {
  if (fault_ != FaultCode::kNone && recovery_ == 0) return;
  recovery_ = 0;
  fault_ = FaultCode::kDeviceSilent;
  blame(Cause::kSilent, 0);
}

// The reason of a slave that has left OP is asked for once.
void EthercatDevice::blame(Cause cause, std::size_t slave) noexcept {
  cause_ = cause;
  culprit_ = slave;
  culprit_status_ = {};
  culprit_word_ = stations_[slave].status;
  culprit_mode_ = stations_[slave].mode_now;
  if (cause != Cause::kLeftOp) return;
  if (const auto status = bus_->status(slave, kStatusPatience)) culprit_status_ = *status;
}

void EthercatDevice::write(const CommandFrame& command) noexcept {
  // a reset in the middle of a stop under control would end it
  if (command.panel.reset && !was_reset_ && !command.enable) recover();
  was_reset_ = command.panel.reset;
  command_ = command;
  has_command_ = true;
  if (command.enable && !is_finite(command)) {
    stop(Cause::kNotFinite, 0, FaultCode::kCommandNotFinite);
  }
}

bool EthercatDevice::is_finite(const CommandFrame& command) const noexcept {
  return command.q_m.size() == config_.n_m && command.q_m.allFinite() &&
         command.dq_p.size() == config_.n_p && command.dq_p.allFinite() &&
         command.tau_m.allFinite();
}

// Slaves are called back to OP; drives are reset by their next control words, and do not move until
// all are well.
void EthercatDevice::recover() noexcept {
  if (cause_ == Cause::kNone || cause_ == Cause::kSilent) return;
  recovery_ = kRecoveryCycles;
  for (std::size_t i = 0; i < stations_.size(); ++i) watches_[i].was_well = is_well(i);
  call_to_op();
}

// Asks slaves in SAFE-OP for OP, and forgives those that have fallen there.
void EthercatDevice::call_to_op() noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (bus_->state(i) == kOp) continue;
    bus_->request_state(i, kSafeOp | kErrorFlag, kStatusPatience);
    bus_->request_state(i, kOp, kStatusPatience);
  }
}

bool EthercatDevice::is_well(std::size_t slave) const noexcept {
  if (bus_->state(slave) != kOp) return false;
  const Station& station = stations_[slave];
  return is_drive(slave) ? !has_failed(state_of(station.status)) : station.error == 0;
}

// What was well since the reset, and is not any more, ends the recovery.
void EthercatDevice::look_at_recovery(int counter) noexcept {
  --recovery_;
  bool are_well = counter == expected_;
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const bool was_well = watches_[i].was_well;
    watches_[i].was_well = is_well(i);
    if (was_well && !watches_[i].was_well && is_in_use_) return fail_again(i);
    are_well = are_well && watches_[i].was_well;
  }
  if (!are_well) return;
  recovery_ = 0;
  fault_ = FaultCode::kNone;
  cause_ = Cause::kNone;
}

// Without a slave that is no drive the monitor keeps the machine stopped.
void EthercatDevice::fail_again(std::size_t slave) noexcept {
  recovery_ = 0;
  if (is_drive(slave)) fault_ = FaultCode::kDriveFault;
  const Cause own = is_drive(slave) ? Cause::kDrive : Cause::kSensor;
  blame(bus_->state(slave) == kOp ? own : Cause::kLeftOp, slave);
}

// Whether drives follow commands in the next exchange.
bool EthercatDevice::may_move() const noexcept {
  const bool is_sound = fault_ == FaultCode::kNone && recovery_ == 0;
  return has_command_ && command_.enable && is_in_use_ && is_sound;
}

// After commands with drives on, the last targets are held until the brakes have closed, where
// drives hear them at all. A drive that leads its own brake is commanded at once.
void EthercatDevice::put_out() noexcept {
  const bool enables = may_move();
  const bool is_stopping = is_stopping_ || fault_ == FaultCode::kDeviceSilent;
  const bool holds = !enables && holding_ > 0 && !is_stopping;
  if (enables) {
    held_ = command_;
    held_.dq_m.setZero();
    held_.dq_p.setZero();
    holding_ = hold_cycles_;
  } else if (holds) {
    held_.panel = command_.panel;
    --holding_;
  } else {
    holding_ = 0;
  }
  Orders orders{.command = has_command_ ? &command_ : nullptr};
  if (holds) orders.command = &held_;
  orders.enables = enables || holds;
  orders.opens_brakes = enables && all_follow();
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const bool is_on = state_of(stations_[i].status) == DriveState::kOperationEnabled;
    orders.control_word = control_word_for(i, enables || (holds && has_brake_outputs_ && is_on));
    put_outputs(config_.machine.slaves[i], config_.n_p, orders, frame_, stations_[i]);
    bus_->set_outputs(i, stations_[i].outputs);
  }
}

bool EthercatDevice::all_follow() const noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (is_drive(i) && !watches_[i].has_followed) return false;
  }
  return true;
}

bool EthercatDevice::any_has_power() const noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (is_drive(i) && has_power(state_of(stations_[i].status))) return true;
  }
  return false;
}

// Drives are off until the first read(); a drive in another mode is not enabled.
std::uint16_t EthercatDevice::control_word_for(std::size_t slave, bool enables) const noexcept {
  // what is known of them may be old
  if (is_stopping_ || fault_ == FaultCode::kDeviceSilent) {
    return is_in_use_ ? kQuickStop : kDisableVoltage;
  }
  const Station& station = stations_[slave];
  const DriveState state = state_of(station.status);
  // a reset needs an edge
  if (state == DriveState::kFault) return recovery_ % 2 == 1 ? kResetFault : kDisableVoltage;
  if (!is_in_use_) return kDisableVoltage;
  const auto mode = static_cast<std::uint8_t>(config_.machine.slaves[slave].mode);
  return control_word(state, enables && (station.mode_now == 0 || station.mode_now == mode));
}

void EthercatDevice::close(FaultCode) noexcept {
  if (is_closed_) return;
  is_closed_ = true;
  recovery_ = 0;
  patience_us_ = std::min(patience_us_, kClosePatience);
  const auto exchange_once = [&] {
    if (exchange() >= 0) take_in();
  };
  command_.enable = false;
  while (holding_ > 0 && !is_silent()) exchange_once();
  is_stopping_ = true;
  for (int i = 0; i < kStopCycles && any_has_power(); ++i) exchange_once();
  is_in_use_ = false;
  for (int i = 0; i < kEndCycles; ++i) exchange_once();
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    bus_->request_state(i, kPreOp, kClosePatience);
  }
}

// State of the drive that has stopped the machine, then; its error code may come later.
std::string EthercatDevice::drive_words() const {
  return fmt::format("'{}' (mode {}, status word {:#06x}, error {:#06x})",
                     to_string(state_of(culprit_word_)), culprit_mode_, culprit_word_,
                     stations_[culprit_].error);
}

std::string EthercatDevice::farewell() const {
  const auto named = [&](const std::string& what) {
    return fmt::format("{}, address {:#06x}: {}", slave_name(config_.machine, culprit_),
                       found_[culprit_].address, what);
  };
  switch (cause_) {
    case Cause::kNone:
      return "";
    case Cause::kIncomplete:
      return fmt::format("{} exchanges in a row were incomplete: working counter {} of {}",
                         kNoticed, culprit_counter_, expected_);
    case Cause::kLeftOp:
      if (culprit_status_.status == 0) return named("does not answer");
      return named(fmt::format("has left OP: {}, AL status code {}",
                               state_name(culprit_status_.status),
                               status_code_words(culprit_status_.code)));
    case Cause::kDrive:
      return named("the drive has failed: " + drive_words());
    case Cause::kDisabled:
      return named("the drive has stopped without a command: " + drive_words());
    case Cause::kNotEnabled:
      return named(
          fmt::format("the drive does not follow after {:g} s: {}", kEnabling, drive_words()));
    case Cause::kNotFollowing:
      return named("the drive no longer follows its commands: " + drive_words());
    case Cause::kOutOfStep:
      return fmt::format(
          "{} frames in a row were out of step with the sync pulses, the last one by {} us: is "
          "this computer busy, or not real-time (hapticgiant doctor)?",
          kNoticed, pace_.error_ns() / 1000);
    case Cause::kSensor:
      return named(fmt::format("the sensor reports fault {:#06x}", stations_[culprit_].error));
    case Cause::kNoSamples:
      return named("the sensor gives no new samples");
    case Cause::kSilent:
      return fmt::format("{}: no answer to {} frames in a row: interface, first cable, first slave",
                         config_.interface_name, kSilent);
    case Cause::kNotFinite:
      return "a command that is not finite was not sent to the drives";
  }
  return "";
}

}  // namespace hg::ethercat

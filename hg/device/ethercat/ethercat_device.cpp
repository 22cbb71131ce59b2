#include "hg/device/ethercat/ethercat_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"
#include "hg/core/monotonic_clock.h"
#include "hg/device/ethercat/bits.h"
#include "hg/device/ethercat/bus_check.h"

namespace hg::ethercat {
namespace {

constexpr std::uint32_t kSilent = 10;  // exchanges without an answer
constexpr std::uint32_t kNoticed = 3;  // exchanges that are not complete, as rule 109
constexpr int kStartCycles = 1000;     // until all drives are without fault
constexpr int kRecoveryCycles = 500;   // until all slaves are in OP again, and no drive at fault
constexpr int kEndCycles = 20;         // until all drives are off
constexpr std::uint32_t kStatusPatience_us = 2'000;  // once, for the reason of a fault
constexpr std::uint32_t kClosePatience_us = 5'000;

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }
std::uint32_t us(double seconds) noexcept {
  return static_cast<std::uint32_t>(std::llround(1e6 * seconds));
}

bool is_switch(Input meaning) noexcept { return meaning >= Input::kDeadMan; }
bool is_unsigned(Input meaning) noexcept {
  return meaning == Input::kStatusWord || meaning == Input::kErrorCode ||
         meaning == Input::kSensorFault || meaning == Input::kSampleCounter || is_switch(meaning);
}

// Value in SI units.
double value_of(const Entry<Input>& entry, std::uint32_t bits) noexcept {
  const double number = is_unsigned(entry.meaning)
                            ? static_cast<double>(bits)
                            : static_cast<double>(signed_of(bits, entry.bits));
  return entry.scale * number + entry.offset;
}

template <typename Vector>
void set(Vector& values, Eigen::Index size, Eigen::Index i, double value) noexcept {
  if (values.size() != size) values = Vector::Zero(size);
  values[i] = value;
}

}  // namespace

EthercatDevice::EthercatDevice(const EthercatConfig& config)
    : config_(config),
      master_(config.interface_name),
      patience_us_(us(config.machine.answer_s)),
      period_ns_(ns(1.0 / config.rate_Hz)) {
  found_ = master_.scan();
  const std::vector<std::string> sentences = differences(master_, found_, config_.machine);
  if (!sentences.empty()) {
    throw SetupError(fmt::format("{}: the bus is not {}:\n{}", config_.interface_name,
                                 config_.machine.name, fmt::join(sentences, "\n")));
  }
  start();
  await_drives();
}

EthercatDevice::~EthercatDevice() { close(fault_); }

void EthercatDevice::start() {
  frame_.q_m = VectorM::Zero(config_.n_m);
  frame_.q_p = VectorP::Zero(config_.n_p);
  const std::vector<Slave>& slaves = config_.machine.slaves;
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    if (slaves[i].is_synchronous) master_.use_sync(i);
  }
  const auto watchdog_ms =
      static_cast<std::uint32_t>(std::lround(1e3 * config_.machine.watchdog_s));
  expected_ = master_.start(watchdog_ms, static_cast<std::uint32_t>(period_ns_));
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    const auto [outputs, inputs] = master_.sizes(i);
    const std::size_t bytes_out = bits_of(slaves[i].outputs) / 8;
    const std::size_t bytes_in = bits_of(slaves[i].inputs) / 8;
    if (outputs != bytes_out || inputs != bytes_in) {
      throw SetupError(
          fmt::format("{}: has {} bytes of outputs and {} of inputs, expected are {} and {}",
                      slave_name(config_.machine, i), outputs, inputs, bytes_out, bytes_in));
    }
    stations_.push_back({.outputs = std::vector<std::uint8_t>(bytes_out),
                         .inputs = std::vector<std::uint8_t>(bytes_in),
                         .is_drive = slaves[i].joint >= 0});
  }
}

// Resets old faults of the drives; they stay off.
void EthercatDevice::await_drives() {
  due_ns_ = now_ns();
  for (int i = 0; i < kStartCycles; ++i) {
    recovery_ = kStartCycles - i;
    put_outputs(nullptr);
    wait_for_turn();
    if (master_.exchange(patience_us_) != expected_) continue;
    take_inputs();
    const bool is_ready = std::ranges::all_of(stations_, [](const Station& station) {
      return !station.is_drive || state_of(station.status) == DriveState::kSwitchOnDisabled;
    });
    if (is_ready) {
      recovery_ = 0;
      return;
    }
  }
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const DriveState state = state_of(stations_[i].status);
    if (!stations_[i].is_drive || state == DriveState::kSwitchOnDisabled) continue;
    throw SetupError(fmt::format("{}: the drive stays in '{}' (status word {:#06x}, error {:#06x})",
                                 slave_name(config_.machine, i), to_string(state),
                                 stations_[i].status, stations_[i].error));
  }
  throw SetupError(config_.interface_name + ": exchanges of process data stay incomplete");
}

void EthercatDevice::wait_for_turn() noexcept {
  if (config_.is_fast) return;
  sleep_until(due_ns_);
  const std::int64_t late = now_ns() - due_ns_;
  // what was missed is not made up for: the machine would see a burst
  due_ns_ += period_ns_ * (1 + std::max<std::int64_t>(0, late / period_ns_));
}

void EthercatDevice::read(SensorFrame& sensors) noexcept {
  if (!is_in_use_) {
    is_in_use_ = true;
    due_ns_ = now_ns();
  }
  ++sequence_;
  if (fault_ == FaultCode::kDeviceSilent) return repeat(sensors);
  wait_for_turn();
  put_outputs(has_command_ ? &command_ : nullptr);
  const int counter = master_.exchange(patience_us_);
  ++counts_.sent;
  if (counter < 0) {
    take_lost();
    return repeat(sensors);
  }
  frame_.bus_errors = 0;
  ++counts_.received;
  lost_in_a_row_ = 0;
  if (has_command_) frame_.answered_sequence = command_.sequence;
  take_inputs();
  look_at_counter(counter);
  look_at_states();
  look_at_drives();
  look_at_sensors();
  if (recovery_ > 0) look_at_recovery();
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
  frame_.bus_errors = static_cast<std::uint32_t>(stations_.size());
  note_incomplete(0);
  if (++lost_in_a_row_ >= kSilent) stop(Cause::kSilent, 0, FaultCode::kDeviceSilent);
}

void EthercatDevice::take_inputs() noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    Station& station = stations_[i];
    const Slave& slave = config_.machine.slaves[i];
    master_.get_inputs(i, station.inputs);
    std::uint32_t at = 0;
    for (const Entry<Input>& entry : slave.inputs) {
      take_input(station, slave, entry, read_bits(station.inputs, at, entry.bits));
      at += entry.bits;
    }
  }
}

void EthercatDevice::take_input(Station& station, const Slave& slave, const Entry<Input>& entry,
                                std::uint32_t bits) noexcept {
  const double value = value_of(entry, bits);
  const bool is_set = (bits != 0) != entry.is_inverted;
  const int n_p = config_.n_p, n_m = config_.n_m, joint = slave.joint - n_p;
  const auto axis = [&](Input first) {
    return static_cast<int>(entry.meaning) - static_cast<int>(first);
  };
  switch (entry.meaning) {
    case Input::kNothing:
    case Input::kModeNow:
      return;
    case Input::kStatusWord:
      station.status = static_cast<std::uint16_t>(bits);
      return;
    case Input::kErrorCode:
    case Input::kSensorFault:
      station.error = static_cast<std::uint16_t>(bits);
      return;
    case Input::kSampleCounter:
      station.has_new_samples = bits != station.samples;
      station.samples = bits;
      return;
    case Input::kLinkPosition:
      if (joint < 0) return set(frame_.q_p, n_p, slave.joint, value);
      return set(frame_.q_m, n_m, joint, value);
    case Input::kLinkVelocity:
      if (joint >= 0) set(frame_.dq_m, n_m, joint, value);
      return;
    case Input::kMotorPosition:
      if (joint >= 0) set(frame_.theta_m, n_m, joint, value);
      return;
    case Input::kJointTorque:
      if (joint >= 0) set(frame_.tau_m, n_m, joint, value);
      return;
    case Input::kTemperature:
      if (joint >= 0) set(frame_.temperature_m, n_m, joint, value);
      return;
    case Input::kForceX:
    case Input::kForceY:
    case Input::kForceZ:
    case Input::kTorqueX:
    case Input::kTorqueY:
    case Input::kTorqueZ:
      frame_.w_S[axis(Input::kForceX)] = value;
      return;
    case Input::kAccelerationX:
    case Input::kAccelerationY:
    case Input::kAccelerationZ:
      frame_.a_S[axis(Input::kAccelerationX)] = value;
      return;
    case Input::kAngularRateX:
    case Input::kAngularRateY:
    case Input::kAngularRateZ:
      frame_.omega_S[axis(Input::kAngularRateX)] = value;
      return;
    case Input::kDeadMan:
      frame_.dead_man = is_set;
      return;
    case Input::kEmergencyStop:
      frame_.safety.emergency_stop = is_set;
      return;
    case Input::kOperatorEnable:
      frame_.safety.operator_enable = is_set;
      return;
    case Input::kOverrideKey:
      frame_.safety.override_key = is_set;
      return;
    case Input::kFieldClear:
      frame_.safety.is_field_clear = is_set;
      return;
    case Input::kInputsDisagree:
      frame_.safety.has_disagreement = is_set;
      return;
  }
}

void EthercatDevice::look_at_counter(int counter) noexcept {
  if (counter == expected_) {
    incomplete_in_a_row_ = 0;
    return;
  }
  frame_.bus_errors = 1;
  note_incomplete(counter);
}

// The monitor stops the device; what it was is kept for farewell().
void EthercatDevice::note_incomplete(int counter) noexcept {
  if (++incomplete_in_a_row_ != kNoticed || cause_ != Cause::kNone) return;
  cause_ = Cause::kIncomplete;
  culprit_counter_ = counter;
}

// A drive that has left OP stops at once; without another slave the device still stops under
// control.
void EthercatDevice::look_at_states() noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (master_.state(i) == kOp) continue;
    ++frame_.bus_errors;
    stop(Cause::kLeftOp, i, stations_[i].is_drive ? FaultCode::kDriveFault : FaultCode::kBusErrors);
  }
}

void EthercatDevice::look_at_drives() noexcept {
  const bool is_enabled = has_command_ && command_.enable && fault_ == FaultCode::kNone;
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    Station& station = stations_[i];
    if (!station.is_drive) continue;
    const DriveState state = state_of(station.status);
    if (has_failed(state)) stop(Cause::kDrive, i, FaultCode::kDriveFault);
    const bool has_stopped = station.has_followed && state != DriveState::kOperationEnabled;
    if (is_enabled && has_stopped) stop(Cause::kDisabled, i, FaultCode::kDriveFault);
    station.has_followed = is_enabled && (station.has_followed || is_following(station.status));
  }
}

void EthercatDevice::look_at_sensors() noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const Station& station = stations_[i];
    if (station.is_drive) continue;
    if (!station.has_new_samples) ++frame_.bus_errors;
    if (station.error != 0) stop(Cause::kSensor, i, FaultCode::kBusErrors);
  }
}

// The first cause counts; the reason of a slave that has left OP is asked for once.
void EthercatDevice::stop(Cause cause, std::size_t slave, FaultCode fault) noexcept {
  if (fault_ != FaultCode::kNone || (recovery_ > 0 && cause != Cause::kSilent)) return;
  fault_ = fault;
  cause_ = cause;
  culprit_ = slave;
  culprit_status_ = {};
  if (cause != Cause::kLeftOp) return;
  if (const auto status = master_.status(slave, kStatusPatience_us)) culprit_status_ = *status;
}

void EthercatDevice::write(const CommandFrame& command) noexcept {
  if (command.panel.reset && !was_reset_) recover();
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

// Asks slaves that have fallen to SAFE-OP back to OP; drives are reset by their next control words.
void EthercatDevice::recover() noexcept {
  if (cause_ == Cause::kSilent) return;
  recovery_ = kRecoveryCycles;
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (master_.state(i) == kOp) continue;
    master_.request_state(i, kSafeOp | kErrorFlag, kStatusPatience_us);
    master_.request_state(i, kOp, kStatusPatience_us);
  }
}

void EthercatDevice::look_at_recovery() noexcept {
  --recovery_;
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const Station& station = stations_[i];
    if (master_.state(i) != kOp) return;
    if (station.is_drive ? has_failed(state_of(station.status)) : station.error != 0) return;
  }
  recovery_ = 0;
  fault_ = FaultCode::kNone;
  cause_ = Cause::kNone;
}

void EthercatDevice::put_outputs(const CommandFrame* command) noexcept {
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    Station& station = stations_[i];
    const Slave& slave = config_.machine.slaves[i];
    std::uint32_t at = 0;
    for (const Entry<Output>& entry : slave.outputs) {
      const double value = output(station, slave, entry.meaning, command);
      const double number = (value - entry.offset) / entry.scale;
      // targets have a sign, words and switches have none
      const bool is_target = entry.meaning >= Output::kTargetPosition;
      const std::uint32_t bits = is_target ? entry.bits : entry.bits + 1;
      write_bits(station.outputs, at, entry.bits, rounded(number, bits));
      at += entry.bits;
    }
    master_.set_outputs(i, station.outputs);
  }
}

// What a slave is told; without a command the drives stay off.
double EthercatDevice::output(const Station& station, const Slave& slave, Output meaning,
                              const CommandFrame* command) const noexcept {
  const bool enables = command != nullptr && command->enable && fault_ == FaultCode::kNone;
  const int joint = slave.joint - config_.n_p;
  switch (meaning) {
    case Output::kNothing:
      return 0.0;
    case Output::kControlWord: {
      const DriveState state = state_of(station.status);
      // a reset needs an edge
      if (state == DriveState::kFault) return recovery_ % 2 == 1 ? kResetFault : kDisableVoltage;
      return is_in_use_ ? control_word(state, enables) : kDisableVoltage;
    }
    case Output::kMode:
      return static_cast<double>(slave.mode);
    case Output::kTargetPosition:
      if (joint >= 0) return enables ? command->q_m[joint] : frame_.q_m[joint];
      return frame_.q_p[slave.joint];
    case Output::kTargetVelocity:
      if (!enables) return 0.0;
      return joint >= 0 ? command->dq_m[joint] : command->dq_p[slave.joint];
    case Output::kTargetTorque:
      return enables && joint >= 0 && joint < command->tau_m.size() ? command->tau_m[joint] : 0.0;
    case Output::kReset:
      return command != nullptr && command->panel.reset ? 1.0 : 0.0;
  }
  return 0.0;
}

void EthercatDevice::close(FaultCode) noexcept {
  if (is_closed_) return;
  is_closed_ = true;
  is_in_use_ = false;
  recovery_ = 0;
  for (int i = 0; i < kEndCycles; ++i) {
    put_outputs(nullptr);
    wait_for_turn();
    if (master_.exchange(std::min(patience_us_, kClosePatience_us)) >= 0) take_inputs();
  }
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    master_.request_state(i, kPreOp, kClosePatience_us);
  }
}

std::string EthercatDevice::farewell() const {
  const auto named = [&](const std::string& what) {
    return fmt::format("{}, address {:#06x}: {}", slave_name(config_.machine, culprit_),
                       found_[culprit_].address, what);
  };
  const auto words = [&] {
    const Station& station = stations_[culprit_];
    return fmt::format("'{}', status word {:#06x}, error {:#06x}",
                       to_string(state_of(station.status)), station.status, station.error);
  };
  switch (cause_) {
    case Cause::kNone:
      return "";
    case Cause::kIncomplete:
      return fmt::format("{} exchanges in a row were incomplete: working counter {} of {}",
                         kNoticed, culprit_counter_, expected_);
    case Cause::kLeftOp:
      if (culprit_status_.status == 0) return named("does not answer");
      return named(fmt::format("has left OP: {}, AL status code {:#06x}",
                               state_name(culprit_status_.status), culprit_status_.code));
    case Cause::kDrive:
      return named("the drive has failed: " + words());
    case Cause::kDisabled:
      return named("the drive has stopped by itself: " + words());
    case Cause::kSensor:
      return named(fmt::format("the sensor reports fault {:#06x}", stations_[culprit_].error));
    case Cause::kSilent:
      return fmt::format("{}: no answer to {} frames in a row: interface, first cable, first slave",
                         config_.interface_name, kSilent);
    case Cause::kNotFinite:
      return "a command that is not finite was not sent to the drives";
  }
  return "";
}

}  // namespace hg::ethercat

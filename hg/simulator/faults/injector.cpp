#include "hg/simulator/faults/injector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "hg/core/error.h"

namespace hg::faults {
namespace {

bool is_of_command(Part part) noexcept {
  return part == Part::kMotor || part == Part::kGantryDrive || part == Part::kPower ||
         part == Part::kCommands || part == Part::kBrake || part == Part::kSafetyChannel;
}

}  // namespace

Injector::Injector(const std::vector<Injection>& injections) {
  for (const Injection& injection : injections) {
    if (injection.kind->effect == Effect::kLate && injection.magnitude > kMostLate) {
      throw SetupError(std::string(injection.kind->name) + ": at most " +
                       std::to_string(kMostLate) + " periods, got " +
                       std::to_string(injection.magnitude));
    }
    faults_.push_back({.injection = injection});
  }
}

bool Injector::is_active(const Fault& fault) const noexcept {
  const Injection& injection = fault.injection;
  const double since_s = now_s_ - injection.from_s;
  return since_s >= 0.0 && (injection.for_s == 0.0 || since_s < injection.for_s);
}

double Injector::faulty_value(const Fault& fault, double value) const noexcept {
  const double magnitude = fault.injection.magnitude;
  switch (fault.injection.kind->effect) {
    case Effect::kNotFinite:
      return std::numeric_limits<double>::quiet_NaN();
    case Effect::kFrozen:
      return fault.held;
    case Effect::kZero:
      return 0.0;
    case Effect::kOffset:
      return value + magnitude;
    case Effect::kDrift:
      return value + magnitude * (now_s_ - fault.injection.from_s);
    case Effect::kFactor:
      return value * magnitude;
    case Effect::kSet:
      return magnitude;
    default:
      return value;
  }
}

template <typename Vector>
void Injector::inject_component(Fault& fault, Vector& v) const noexcept {
  const int index = fault.injection.index;
  if (index >= v.size()) return;  // this device has no such sensor
  if (!fault.has_begun) fault.held = v[index];
  v[index] = faulty_value(fault, v[index]);
}

void Injector::inject(SensorFrame& sensors) noexcept {
  if (!has_started_) start_s_ = sensors.time_s;
  has_started_ = true;
  now_s_ = sensors.time_s - start_s_;
  for (Fault& fault : faults_) {
    const Part part = fault.injection.kind->part;
    if (is_of_command(part) || !is_active(fault)) continue;
    if (!fault.has_begun) fault.sensors = sensors;
    inject_sensors(fault, sensors);
    inject_inputs(fault, sensors);
    inject_samples(fault, sensors);
    fault.has_begun = true;
  }
}

void Injector::inject_sensors(Fault& fault, SensorFrame& sensors) noexcept {
  switch (fault.injection.kind->part) {
    case Part::kLinkEncoder:
      return inject_component(fault, sensors.q_m);
    case Part::kLinkSpeed:
      return inject_component(fault, sensors.dq_m);
    case Part::kMotorEncoder:
      return inject_component(fault, sensors.theta_m);
    case Part::kJointEncoders:
      inject_component(fault, sensors.theta_m);
      return inject_component(fault, sensors.q_m);
    case Part::kTorqueSensor:
      return inject_component(fault, sensors.tau_m);
    case Part::kGantryEncoder:
      return inject_component(fault, sensors.q_p);
    case Part::kGantryCoupling: {
      const int axis = fault.injection.index;
      if (axis < sensors.q_p.size()) sensors.q_p[axis] -= slip_of(fault.injection).way;
      return;
    }
    case Part::kForceSensor:
      return inject_component(fault, sensors.w_S);
    case Part::kAccelerometer:
      return inject_component(fault, sensors.a_S);
    case Part::kGyroscope:
      return inject_component(fault, sensors.omega_S);
    case Part::kTemperature:
      return inject_component(fault, sensors.temperature_m);
    default:
      return;
  }
}

void Injector::inject_inputs(const Fault& fault, SensorFrame& sensors) const noexcept {
  switch (fault.injection.kind->part) {
    case Part::kDeadMan:
      sensors.dead_man = false;
      return;
    case Part::kEmergencyStop:
      sensors.safety.emergency_stop = true;
      return;
    case Part::kOperatorEnable:
      sensors.safety.operator_enable = false;
      return;
    case Part::kSafetyChannels:
      sensors.safety.has_disagreement = true;
      return;
    case Part::kBus:
      sensors.bus_errors = static_cast<std::uint32_t>(fault.injection.magnitude);
      return;
    case Part::kDrive:
      sensors.driver_fault = FaultCode::kDriveFault;
      return;
    default:
      return;
  }
}

void Injector::inject_samples(const Fault& fault, SensorFrame& sensors) const noexcept {
  switch (fault.injection.kind->part) {
    case Part::kClock: {
      const double since_s = sensors.time_s - fault.sensors.time_s;
      const double speed =
          fault.injection.kind->effect == Effect::kFactor ? fault.injection.magnitude : 0.0;
      sensors.time_s = fault.sensors.time_s + speed * since_s;
      return;
    }
    case Part::kSamples:
      if (fault.injection.kind->effect == Effect::kLost) {
        sensors.sequence += static_cast<std::uint64_t>(fault.injection.magnitude);
      } else {
        sensors = fault.sensors;
      }
      return;
    case Part::kAnswers:
      sensors.answered_sequence = fault.sensors.answered_sequence;
      return;
    default:
      return;
  }
}

void Injector::inject(CommandFrame& command) noexcept {
  if (!has_commanded_) past_.fill(command);
  has_commanded_ = true;
  newest_ = (newest_ + 1) % past_.size();
  past_[newest_] = command;
  hardware_ = {};
  for (Fault& fault : faults_) {
    const Part part = fault.injection.kind->part;
    if (!is_active(fault)) continue;
    const int index = fault.injection.index;
    if (part == Part::kGantryCoupling && index < command.dq_p.size()) {
      command.dq_p[index] += slip_of(fault.injection).speed;
    }
    if (!is_of_command(part)) continue;
    inject_command(fault, command);
    inject_hardware(fault.injection);
    fault.has_begun = true;
  }
}

void Injector::inject_command(Fault& fault, CommandFrame& command) const noexcept {
  const Part part = fault.injection.kind->part;
  if (part == Part::kMotor) inject_component(fault, command.tau_m);
  if (part == Part::kGantryDrive) inject_component(fault, command.dq_p);
  if (part == Part::kPower) command.enable = false;
  if (part == Part::kCommands) {
    const auto age = static_cast<std::size_t>(fault.injection.magnitude);
    if (!fault.has_begun) fault.command = command;
    command = fault.injection.kind->effect == Effect::kLate
                  ? past_[(newest_ + past_.size() - age) % past_.size()]
                  : fault.command;
  }
}

// An axis that separates from its drive accelerates gradually: at the speed of its drive a
// controller could not distinguish it from an encoder jump.
Injector::Slip Injector::slip_of(const Injection& injection) const noexcept {
  constexpr double kAcceleration = 1.0;  // m/s^2 or rad/s^2
  const double since_s = now_s_ - injection.from_s;
  const double ramp_s = std::min(since_s, std::abs(injection.magnitude) / kAcceleration);
  const double speed = std::copysign(kAcceleration * ramp_s, injection.magnitude);
  return {.speed = speed, .way = speed * (since_s - 0.5 * ramp_s)};
}

void Injector::inject_hardware(const Injection& injection) noexcept {
  const std::uint32_t bit = 1U << static_cast<unsigned>(injection.index);
  const bool is_raised = injection.kind->effect == Effect::kRaised;
  if (injection.kind->part == Part::kBrake) {
    (is_raised ? hardware_.closed_brakes : hardware_.weak_brakes) |= bit;
  }
  if (injection.kind->part == Part::kSafetyChannel) {
    (is_raised ? hardware_.stuck_channels : hardware_.open_channels) |= bit;
  }
}

}  // namespace hg::faults

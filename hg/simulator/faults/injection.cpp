#include "hg/simulator/faults/injection.h"

#include <algorithm>
#include <array>

#include "hg/simulator/hardware_faults.h"

namespace hg::faults {
namespace {

constexpr std::array kKinds = {
    Kind{"link_encoder_nan", "a link encoder gives NaN", Part::kLinkEncoder, Effect::kNotFinite},
    Kind{"link_encoder_frozen", "a link encoder is frozen", Part::kLinkEncoder, Effect::kFrozen},
    Kind{"link_encoder_jump",
         "a link encoder has slipped",
         Part::kLinkEncoder,
         Effect::kOffset,
         {0.05, 0.5},
         "rad",
         true},
    Kind{"link_encoder_drift",
         "a link encoder drifts",
         Part::kLinkEncoder,
         Effect::kDrift,
         {0.05, 0.5},
         "rad/s",
         true},
    Kind{"link_encoder_zero", "a link encoder shows zero", Part::kLinkEncoder, Effect::kZero},
    Kind{"link_speed_nan", "a joint speed is NaN", Part::kLinkSpeed, Effect::kNotFinite},
    Kind{"link_speed_frozen", "a joint speed is frozen", Part::kLinkSpeed, Effect::kFrozen},
    Kind{"link_speed_offset",
         "a joint speed is wrong",
         Part::kLinkSpeed,
         Effect::kOffset,
         {0.2, 2.0},
         "rad/s",
         true},
    Kind{"motor_encoder_nan", "a motor encoder gives NaN", Part::kMotorEncoder, Effect::kNotFinite},
    Kind{"motor_encoder_frozen", "a motor encoder is frozen", Part::kMotorEncoder, Effect::kFrozen},
    Kind{"motor_encoder_jump",
         "a motor encoder has slipped",
         Part::kMotorEncoder,
         Effect::kOffset,
         {0.05, 0.5},
         "rad",
         true},
    Kind{"motor_encoder_drift",
         "a motor encoder drifts",
         Part::kMotorEncoder,
         Effect::kDrift,
         {0.05, 0.5},
         "rad/s",
         true},
    Kind{"joint_encoders_jump",
         "both encoders of a joint have slipped alike",
         Part::kJointEncoders,
         Effect::kOffset,
         {0.05, 0.5},
         "rad",
         true},
    Kind{"joint_encoders_drift",
         "both encoders of a joint drift alike",
         Part::kJointEncoders,
         Effect::kDrift,
         {0.02, 0.5},
         "rad/s",
         true},
    Kind{"torque_sensor_nan", "a joint torque is NaN", Part::kTorqueSensor, Effect::kNotFinite},
    Kind{"torque_sensor_frozen", "a joint torque is frozen", Part::kTorqueSensor, Effect::kFrozen},
    Kind{"torque_sensor_offset",
         "a joint torque is wrong",
         Part::kTorqueSensor,
         Effect::kOffset,
         {10.0, 60.0},
         "Nm",
         true},
    Kind{"torque_sensor_zero", "a joint torque shows zero", Part::kTorqueSensor, Effect::kZero},
    Kind{"gantry_encoder_nan", "a gantry encoder gives NaN", Part::kGantryEncoder,
         Effect::kNotFinite},
    Kind{"gantry_encoder_frozen", "a gantry encoder is frozen", Part::kGantryEncoder,
         Effect::kFrozen},
    Kind{"gantry_encoder_jump",
         "a gantry encoder has slipped",
         Part::kGantryEncoder,
         Effect::kOffset,
         {0.02, 0.3},
         "m",
         true},
    Kind{"gantry_encoder_drift",
         "a gantry encoder drifts",
         Part::kGantryEncoder,
         Effect::kDrift,
         {0.005, 0.5},
         "m/s",
         true},
    Kind{"force_sensor_nan", "the force/torque sensor gives NaN", Part::kForceSensor,
         Effect::kNotFinite},
    Kind{"force_sensor_frozen", "a component of the force/torque sensor is frozen",
         Part::kForceSensor, Effect::kFrozen},
    Kind{"force_sensor_zero", "a component of the force/torque sensor shows zero",
         Part::kForceSensor, Effect::kZero},
    Kind{"force_sensor_offset",
         "a component of the force/torque sensor is wrong",
         Part::kForceSensor,
         Effect::kOffset,
         {5.0, 140.0},
         "N",
         true},
    Kind{"force_sensor_overload",
         "the force/torque sensor saturates",
         Part::kForceSensor,
         Effect::kSet,
         {160.0, 1000.0},
         "N",
         true},
    Kind{"accelerometer_nan", "the accelerometer gives NaN", Part::kAccelerometer,
         Effect::kNotFinite},
    Kind{"accelerometer_frozen", "the accelerometer is frozen", Part::kAccelerometer,
         Effect::kFrozen},
    Kind{"gyroscope_nan", "the gyroscope gives NaN", Part::kGyroscope, Effect::kNotFinite},
    Kind{"gyroscope_frozen", "the gyroscope is frozen", Part::kGyroscope, Effect::kFrozen},
    Kind{"motor_hot",
         "a motor is too hot",
         Part::kTemperature,
         Effect::kSet,
         {100.0, 200.0},
         "degrees Celsius"},
    Kind{"dead_man_open", "the dead-man switch opens while the hand holds it", Part::kDeadMan,
         Effect::kDropped},
    Kind{"emergency_stop", "the emergency stop is pressed", Part::kEmergencyStop, Effect::kRaised},
    Kind{"operator_released", "the operator lets go of the enabling switch", Part::kOperatorEnable,
         Effect::kDropped},
    Kind{"safety_channels_differ", "the channels of a safety input differ", Part::kSafetyChannels,
         Effect::kRaised},
    Kind{"safety_channel_opens", "one of the two wires of a safety input breaks",
         Part::kSafetyChannel, Effect::kDropped},
    Kind{"safety_channel_stuck", "one of the two wires of a safety input stays on",
         Part::kSafetyChannel, Effect::kRaised},
    Kind{"clock_stops", "the device's clock stands still", Part::kClock, Effect::kFrozen},
    Kind{"clock_wrong",
         "the device's clock runs at another speed",
         Part::kClock,
         Effect::kFactor,
         {1.02, 1.5},
         "times as fast"},
    Kind{"samples_lost",
         "samples do not arrive",
         Part::kSamples,
         Effect::kLost,
         {1.0, 50.0},
         "samples"},
    Kind{"samples_repeated", "one sample arrives again and again", Part::kSamples, Effect::kFrozen},
    Kind{"bus_errors",
         "answers of the fieldbus are missing",
         Part::kBus,
         Effect::kSet,
         {1.0, 3.0},
         "answers"},
    Kind{"drive_fault", "a drive reports a fault", Part::kDrive, Effect::kRaised},
    Kind{"answers_stop", "the device does not report which command is in effect", Part::kAnswers,
         Effect::kFrozen},
    Kind{"motor_dead", "a motor gives no torque", Part::kMotor, Effect::kZero},
    Kind{"motor_weak",
         "a motor gives less torque",
         Part::kMotor,
         Effect::kFactor,
         {0.2, 0.9},
         "of the torque"},
    Kind{"motor_offset",
         "a motor gives another torque",
         Part::kMotor,
         Effect::kOffset,
         {5.0, 60.0},
         "Nm",
         true},
    Kind{"motor_frozen", "the torque of a motor is frozen", Part::kMotor, Effect::kFrozen},
    Kind{"gantry_dead", "a gantry axis does not move", Part::kGantryDrive, Effect::kZero},
    Kind{"gantry_runaway",
         "a gantry axis is faster than commanded",
         Part::kGantryDrive,
         Effect::kOffset,
         {0.1, 1.0},
         "m/s",
         true},
    Kind{"gantry_slips",
         "a gantry axis moves while its encoder shows the commanded motion",
         Part::kGantryCoupling,
         Effect::kDrift,
         {0.2, 1.0},
         "m/s",
         true},
    Kind{"gantry_frozen", "a gantry axis keeps its speed", Part::kGantryDrive, Effect::kFrozen},
    Kind{"brake_closes", "the brake of a joint closes without a command", Part::kBrake,
         Effect::kRaised},
    Kind{"brake_weak", "the brake of a joint does not hold", Part::kBrake, Effect::kDropped},
    Kind{"power_lost", "the drives lose their power", Part::kPower, Effect::kDropped},
    Kind{"commands_lost", "the drives get no new commands", Part::kCommands, Effect::kFrozen},
    Kind{"commands_late",
         "commands take longer to the drives",
         Part::kCommands,
         Effect::kLate,
         {1.0, 8.0},
         "periods"},
    Kind{"cycles_late", "cycles come too late", Part::kCycles, Effect::kSet, {1.0, 20.0}, "cycles"},
    Kind{"solver_hurried",
         "the solver is ended before it has finished",
         Part::kSolver,
         Effect::kSet,
         {1.0, 3.0},
         "active sets"},
};

}  // namespace

std::span<const Kind> kinds() noexcept { return kKinds; }

const Kind* find_kind(std::string_view name) noexcept {
  const auto found = std::ranges::find(kKinds, name, &Kind::name);
  return found == kKinds.end() ? nullptr : &*found;
}

bool is_count(const Kind& kind) noexcept {
  return kind.effect == Effect::kLost || kind.effect == Effect::kLate || kind.part == Part::kBus ||
         kind.part == Part::kCycles || kind.part == Part::kSolver;
}

std::vector<TimedLoad> loads_of(const std::vector<Injection>& injections) {
  std::vector<TimedLoad> loads;
  for (const Injection& injection : injections) {
    if (injection.kind->part != Part::kCycles) continue;
    const auto count = static_cast<std::uint32_t>(injection.magnitude);
    loads.push_back({injection.from_s, injection.for_s, count});
  }
  return loads;
}

std::vector<SolverCap> solver_caps_of(const std::vector<Injection>& injections) {
  std::vector<SolverCap> caps;
  for (const Injection& injection : injections) {
    if (injection.kind->part != Part::kSolver) continue;
    const auto count = static_cast<std::uint32_t>(injection.magnitude);
    caps.push_back({injection.from_s, injection.for_s, count});
  }
  return caps;
}

bool is_of_hardware(const Injection& injection) noexcept {
  return injection.kind->part == Part::kBrake || injection.kind->part == Part::kSafetyChannel;
}

int parts_of(Part part, int n_m, int n_p) noexcept {
  switch (part) {
    case Part::kLinkEncoder:
    case Part::kLinkSpeed:
    case Part::kMotorEncoder:
    case Part::kTorqueSensor:
    case Part::kTemperature:
    case Part::kMotor:
    case Part::kBrake:
    case Part::kJointEncoders:
      return n_m;
    case Part::kGantryEncoder:
    case Part::kGantryDrive:
    case Part::kGantryCoupling:
      return n_p;
    case Part::kForceSensor:
      return 6;
    case Part::kAccelerometer:
    case Part::kGyroscope:
      return 3;
    case Part::kSafetyChannel:
      return simulator::kSafetyInputs;
    default:
      return 0;
  }
}

}  // namespace hg::faults

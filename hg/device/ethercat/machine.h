/// A machine on an EtherCAT bus: its slaves in the order of the cable, and what their process data
/// mean. Set-up data, filled by config from machine.yaml.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hg::ethercat {

/// What an entry of its process data commands a slave.
enum class Output : std::uint8_t {
  kNothing,  ///< always 0
  kControlWord,
  kMode,
  kTargetPosition,
  kTargetVelocity,
  kTargetTorque,
  kReset,       ///< reset button of the safety controller
  kOpenBrakes,  ///< while all drives follow; for brakes that no drive opens
};

/// What an entry of its process data reports.
enum class Input : std::uint8_t {
  kNothing,  ///< is not looked at
  kStatusWord,
  kModeNow,
  kErrorCode,
  kLinkPosition,  ///< of the joint; of a gantry axis its position
  kLinkVelocity,
  kMotorPosition,  ///< at the output of the gear
  kJointTorque,    ///< of the sensor between gear and link
  kTemperature,    ///< of the motor
  kForceX,         ///< of the handle's sensor, as the other five
  kForceY,
  kForceZ,
  kTorqueX,
  kTorqueY,
  kTorqueZ,
  kAccelerationX,  ///< of the inertial unit in the handle, as the other five
  kAccelerationY,
  kAccelerationZ,
  kAngularRateX,
  kAngularRateY,
  kAngularRateZ,
  kSensorFault,    ///< of a sensor; 0: it works
  kSampleCounter,  ///< of a sensor, which changes with every sample
  kDeadMan,
  kEmergencyStop,
  kOperatorEnable,
  kOverrideKey,
  kFieldClear,
  kInputsDisagree,
};

/// Whether an entry has a value in SI units, else a number, a switch or nothing.
inline constexpr bool is_measure(Output meaning) noexcept {
  return meaning == Output::kTargetPosition || meaning == Output::kTargetVelocity ||
         meaning == Output::kTargetTorque;
}
inline constexpr bool is_measure(Input meaning) noexcept {
  return Input::kLinkPosition <= meaning && meaning <= Input::kAngularRateZ;
}

/// How a drive is led: modes of CiA 402, with their numbers.
enum class DriveMode : std::uint8_t { kNone = 0, kCsp = 8, kCsv = 9, kCst = 10 };

/// One entry of process data. Its value in SI units is scale * number + offset.
template <typename Meaning>
struct Entry {
  std::uint32_t object = 0;  ///< 0: a gap
  std::uint32_t subindex = 0;
  std::uint32_t bits = 0;  ///< 1 to 32
  Meaning meaning = Meaning::kNothing;
  double scale = 1.0;        ///< SI units per count; negative: the other way round
  double offset = 0.0;       ///< SI units at the number 0
  bool is_inverted = false;  ///< of a switch: 0 says yes
};

/// An object that is written before the slave operates, and read back.
struct Setting {
  std::uint32_t object = 0;
  std::uint32_t subindex = 0;
  std::uint32_t bits = 0;  ///< 8, 16 or 32
  double value = 0.0;      ///< a whole number
};

struct Slave {
  std::string name;
  std::uint32_t vendor = 0, product = 0, revision = 0;
  int joint = -1;  ///< index in the chain of the device, gantry first; -1: no drive
  DriveMode mode = DriveMode::kNone;
  bool is_synchronous = false;  ///< gets sync pulses of the distributed clocks
  std::vector<Setting> settings;
  std::vector<Entry<Output>> outputs;  ///< in the order of its process data
  std::vector<Entry<Input>> inputs;
};

struct Machine {
  std::string name;
  double watchdog_s = 0.1;  ///< without outputs for so long a slave leaves OP
  double answer_s = 5e-4;   ///< a frame that takes longer is lost
  /// From the command to close a brake until it holds. For so long torques stay, and drives on,
  /// where the output open_brakes leads the brakes.
  double brake_closing_s = 0.0;
  /// The slaves move a period with each frame, whenever it comes: a simulated segment.
  bool moves_with_frames = false;
  std::vector<Slave> slaves;
};

/// Number of bits of all entries.
template <typename Meaning>
std::uint32_t bits_of(const std::vector<Entry<Meaning>>& entries) noexcept {
  std::uint32_t bits = 0;
  for (const Entry<Meaning>& entry : entries) bits += entry.bits;
  return bits;
}

}  // namespace hg::ethercat

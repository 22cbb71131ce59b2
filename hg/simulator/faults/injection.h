/// Fault injection: possible faults of a machine, its link and its computer, as data.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hg/core/interval.h"
#include "hg/signals/timed_load.h"

namespace hg::faults {

/// Part of the system that a fault affects.
enum class Part : std::uint8_t {
  kLinkEncoder,
  kLinkSpeed,
  kMotorEncoder,
  kTorqueSensor,
  kGantryEncoder,
  kForceSensor,
  kAccelerometer,
  kGyroscope,
  kTemperature,
  kDeadMan,
  kEmergencyStop,
  kOperatorEnable,
  kSafetyChannels,
  kClock,
  kSamples,
  kBus,
  kDrive,
  kAnswers,
  kMotor,
  kGantryDrive,
  kPower,
  kCommands,
  kCycles,
  kSolver,
  kBrake,
  kSafetyChannel,
  kJointEncoders,   ///< link-side and motor-side encoders together
  kGantryCoupling,  ///< an axis moves while its encoder reports the commanded motion
};

/// Effect of a fault on the part's value or behaviour.
enum class Effect : std::uint8_t {
  kNotFinite,  ///< NaN
  kFrozen,     ///< value held from when the fault began
  kZero,
  kOffset,   ///< value plus the magnitude
  kDrift,    ///< value plus the magnitude for each second
  kFactor,   ///< value times the magnitude
  kSet,      ///< value replaced by the magnitude
  kRaised,   ///< a truth value: true; a brake closes
  kDropped,  ///< a truth value: false; a brake does not hold
  kLost,     ///< the magnitude is the number lost
  kLate,     ///< the magnitude is the delay in periods
};

/// Kind of fault that can be injected.
struct Kind {
  std::string_view name;  ///< name in scenario.yaml
  std::string_view what;  ///< one-line description
  Part part;
  Effect effect;
  /// Range of useful magnitudes; one tenth of it for a torque of the force sensor.
  Interval magnitude{};
  /// Unit of the magnitude; Nm instead of N for a torque of the force sensor
  std::string_view unit;
  bool has_sign = false;  ///< the magnitude may be negative, too
};

/// All kinds of faults.
std::span<const Kind> kinds() noexcept;
/// Finds a kind by name; null: no such kind.
const Kind* find_kind(std::string_view name) noexcept;
/// Whether the magnitude of a kind is a whole number, at least 1.
bool is_count(const Kind& kind) noexcept;
/// Number of joints, axes or components of a part; 0 = not divided.
int parts_of(Part part, int n_m, int n_p) noexcept;

inline constexpr int kMostLate = 16;         ///< largest delay of a command, periods
inline constexpr double kMostCounted = 1e6;  ///< largest value of all other counts

/// Fault injected into a run.
struct Injection {
  const Kind* kind = nullptr;
  int index = 0;           ///< joint, axis or component, from 0
  double magnitude = 0.0;  ///< magnitude in the unit of its kind
  double from_s = 0.0;     ///< start on the device's clock since its first sample, s
  double for_s = 0.0;      ///< duration, s; 0 = until the end
};

/// The faults of the computer that runs the cycle: cycles_late as load of a run, solver_hurried as
/// caps of its solver. All others are faults of the device: see FaultyDevice.
std::vector<TimedLoad> loads_of(const std::vector<Injection>& injections);
std::vector<SolverCap> solver_caps_of(const std::vector<Injection>& injections);
/// Whether a fault is inside the machine, where no frame shows it: a brake, or one channel of a
/// safety input.
bool is_of_hardware(const Injection& injection) noexcept;

}  // namespace hg::faults

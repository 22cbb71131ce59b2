/// Faults on purpose: what of a machine, its link and its computer may go wrong, as data.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "hg/core/interval.h"

namespace hg::injection {

/// What is spoilt.
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
  kJointEncoders,   ///< link side and motor side alike
  kGantryCoupling,  ///< an axis moves while its encoder says that it does as told
};

/// What becomes of it.
enum class Effect : std::uint8_t {
  kNotFinite,  ///< NaN
  kFrozen,     ///< as it was when the fault began
  kZero,
  kOffset,   ///< plus the magnitude
  kDrift,    ///< plus the magnitude for each second
  kFactor,   ///< times the magnitude
  kSet,      ///< is the magnitude
  kRaised,   ///< a truth value: true; a brake closes
  kDropped,  ///< a truth value: false; a brake does not hold
  kLost,     ///< so many do not arrive
  kLate,     ///< arrives so many periods later
};

/// One thing that can go wrong.
struct Kind {
  std::string_view name;  ///< as in scenario.yaml
  std::string_view what;  ///< one line for people
  Part part;
  Effect effect;
  /// From the least that is worth trying to the largest; of a torque of the force sensor a tenth.
  Interval magnitude{};
  std::string_view unit;  ///< of the magnitude; of a torque of the force sensor Nm instead of N
  bool has_sign = false;  ///< the magnitude may be negative, too
};

/// All of them.
std::span<const Kind> kinds() noexcept;
/// Null: there is no such kind.
const Kind* find_kind(std::string_view name) noexcept;
/// Its magnitude is a whole number from 1 on.
bool is_count(const Kind& kind) noexcept;
/// Joint, axis or component that is spoilt; 0 = it has no parts.
int parts_of(Part part, int n_m, int n_p) noexcept;

inline constexpr int kMostLate = 16;         ///< periods that a command may be late
inline constexpr double kMostCounted = 1e6;  ///< of all other counts

/// One fault of a run.
struct Injection {
  const Kind* kind = nullptr;
  int index = 0;           ///< joint, axis or component, from 0
  double magnitude = 0.0;  ///< in the unit of its kind
  double from_s = 0.0;     ///< on the device's clock since its first sample
  double for_s = 0.0;      ///< 0 = until the end
};

}  // namespace hg::injection

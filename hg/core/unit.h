/// Units of the numbers in a field (hg/core/fields.h).
#pragma once

#include <cstdint>
#include <string>

namespace hg {

/// Unit of a field's numbers. Fields of joints have two: what turns is in rad, what slides in m; so
/// have wrenches, twists and poses of six numbers.
struct Unit {
  enum class Per : std::uint8_t {
    kField,  ///< `linear` is the unit of all numbers
    kJoint,  ///< `angular` of joints that turn, `linear` of joints that slide
    kHalf,   ///< Of six numbers the first three are `linear`, the others `angular`
  };

  const char* linear = "";
  const char* angular = "";
  Per per = Per::kField;

  /// Text for people and files: "s", "rad or m" per joint, "N, Nm" per half; "" without a unit.
  std::string text() const {
    const std::string first = linear, second = angular;
    if (per == Per::kJoint) return second + " or " + first;
    return per == Per::kHalf ? first + ", " + second : first;
  }
};

/// A note with the unit in brackets before it: "[rad or m] positions of the gantry".
inline std::string with_unit(const std::string& note, const Unit& unit) {
  const std::string text = unit.text();
  if (text.empty()) return note;
  return "[" + text + "]" + (note.empty() ? "" : " ") + note;
}

namespace unit {

/// A number without a unit, or with one that other fields determine.
inline constexpr Unit kNone{};

inline constexpr Unit kS{"s"};
inline constexpr Unit kUs{"us"};
inline constexpr Unit kNs{"ns"};
inline constexpr Unit kBytes{"bytes"};
inline constexpr Unit kHz{"Hz"};
inline constexpr Unit kM{"m"};
inline constexpr Unit kRad{"rad"};
inline constexpr Unit kMPerS{"m/s"};
inline constexpr Unit kRadPerS{"rad/s"};
inline constexpr Unit kMPerS2{"m/s^2"};
inline constexpr Unit kN{"N"};
inline constexpr Unit kNsPerM{"Ns/m"};
inline constexpr Unit kNPerCm2{"N/cm^2"};
inline constexpr Unit kJ{"J"};
inline constexpr Unit kDegC{"degC"};

// of joints: gantry, manipulator, twin, or limited quantities
inline constexpr Unit kJointPosition{"m", "rad", Unit::Per::kJoint};
inline constexpr Unit kJointSpeed{"m/s", "rad/s", Unit::Per::kJoint};
inline constexpr Unit kJointAcceleration{"m/s^2", "rad/s^2", Unit::Per::kJoint};
inline constexpr Unit kJointTorque{"N", "Nm", Unit::Per::kJoint};

// of six numbers
inline constexpr Unit kDisplacement{"m", "rad", Unit::Per::kHalf};
inline constexpr Unit kTwist{"m/s", "rad/s", Unit::Per::kHalf};
inline constexpr Unit kAcceleration{"m/s^2", "rad/s^2", Unit::Per::kHalf};
inline constexpr Unit kImu{"m/s^2", "rad/s", Unit::Per::kHalf};
inline constexpr Unit kWrench{"N", "Nm", Unit::Per::kHalf};

}  // namespace unit

}  // namespace hg

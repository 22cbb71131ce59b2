/// Numbers that can only be in another unit: compared with what machines have, and the value in the
/// expected unit.
///
/// Set-up only: allocates. An empty sentence means that nothing is suspected.
#pragma once

#include <array>
#include <numbers>
#include <span>
#include <string>

#include "hg/core/interval.h"

namespace hg {

/// A unit that a number may be in, and its size in the expected unit.
struct OtherUnit {
  const char* name;
  double size;
};

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< rad

inline constexpr std::array kOtherAngles = {OtherUnit{"degrees", kDegree}};
inline constexpr std::array kOtherSpeeds = {
    OtherUnit{"degrees per second", kDegree},
    OtherUnit{"revolutions per minute", std::numbers::pi / 30.0}};
inline constexpr std::array kOtherAccelerations = {OtherUnit{"degrees per second^2", kDegree}};
inline constexpr std::array kOtherLengths = {OtherUnit{"millimetres", 1e-3}};
inline constexpr std::array kOtherMasses = {OtherUnit{"grams", 1e-3}};
inline constexpr std::array kOtherInertias = {OtherUnit{"kg cm^2", 1e-4},
                                              OtherUnit{"kg mm^2", 1e-6}, OtherUnit{"g cm^2", 1e-7},
                                              OtherUnit{"g mm^2", 1e-9}};
inline constexpr std::array kOtherTorques = {OtherUnit{"kgf m", 9.80665},
                                             OtherUnit{"kgf cm", 0.0980665}, OtherUnit{"Ncm", 1e-2},
                                             OtherUnit{"Nmm", 1e-3}};
inline constexpr std::array kOtherForces = {OtherUnit{"kgf", 9.80665}, OtherUnit{"lbf", 4.44822},
                                            OtherUnit{"gf", 9.80665e-3}, OtherUnit{"mN", 1e-3}};
inline constexpr std::array kOtherStiffnesses = {OtherUnit{"Nm/deg", 1.0 / kDegree},
                                                 OtherUnit{"Nm/arcmin", 60.0 / kDegree}};

/// "suspected degrees: 1.571 rad", with all of `others` in which `value`, itself not plausible,
/// would be; empty without any.
std::string suspected_unit(double value, const Interval& plausible,
                           std::span<const OtherUnit> others, const char* unit);

/// "; suspected ..." to end a sentence with; empty without a suspicion.
std::string after_semicolon(const std::string& suspected);

/// Whether an angle is too large for a joint: more than four turns, or a multiple of 5 from 15 on.
/// Whole half turns, also rounded to a digit after the point, are those of a screw or wheel. rad.
bool is_odd_angle(double angle) noexcept;
/// Whether a number is 10, 100, ...: files have such for "no limit".
bool is_power_of_ten(double value) noexcept;
/// Whether a speed is too large for a joint of any arm, rad/s. Powers of ten and their halves stand
/// for no limit.
bool is_odd_speed(double speed) noexcept;

/// "90 rad are 14.3 turns; suspected degrees: 1.571 rad", of the angle of a joint.
std::string doubt_of_angle(double angle);
/// Of roll, pitch or yaw, which one turn covers.
std::string doubt_of_orientation(double angle);
/// Of the largest speed of a joint, rad/s.
std::string doubt_of_speed(double speed);
/// Of a length or the travel of a machine that a person holds, m: beyond 60 m.
std::string doubt_of_length(double length);

}  // namespace hg

#include "hg/config/suspected_unit.h"

#include <cmath>

#include "hg/core/unit_doubt.h"

namespace hg::config {
std::string suspected_of(double value, std::string_view unit) {
  constexpr Interval kUsual = {-30.0, 30.0};  // m, rad or rad/s
  std::span<const OtherUnit> others;
  if (unit == "m") others = kOtherLengths;
  if (unit == "rad") others = kOtherAngles;
  if (unit == "rad/s") others = kOtherSpeeds;
  return after_semicolon(suspected_unit(value, kUsual, others, std::string(unit).c_str()));
}

std::string with_suspected_degrees(double position, const limits::JointLimits& limits,
                                   JointUnit unit) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::span<const OtherUnit> others;
  if (unit != JointUnit::kLength && std::abs(position) > kTurn) others = kOtherAngles;
  return model::to_text(position) +
         after_semicolon(suspected_unit(position, {limits.q_min, limits.q_max}, others, "rad"));
}

}  // namespace hg::config

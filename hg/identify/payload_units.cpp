#include "hg/identify/payload_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hg/core/unit_doubt.h"

namespace hg::identify {
namespace {

constexpr double kGravity = 9.81;
constexpr double kMostHeld = 50.0;  // kg; a person moves no more
constexpr double kHeld = 1.0;       // m, from the sensor to the end of what a person holds
constexpr double kAlike = 0.2;      // share by which a weighed payload may differ from its drawing

Interval around(double value) { return {(1.0 - kAlike) * value, (1.0 + kAlike) * value}; }

std::string doubt_of_mass(double mass, double expected) {
  // a number of these units, multiplied by its size, is in N; a mass from it is in kg
  const bool is_known = expected > 0.0;
  const Interval plausible = is_known ? around(expected) : Interval{0.0, kMostHeld};
  if (plausible.contains(mass)) return "";
  const std::string suspected = suspected_unit(mass, plausible, kOtherForces, "kg");
  const bool is_huge = mass > kMostHeld;
  if (suspected.empty() && !is_huge) return "";
  return fmt::format("f: the mass is {:.4g} kg, {}; {}", mass,
                     is_known ? fmt::format("device.yaml has {:.4g} kg", expected)
                              : std::string("more than a person holds"),
                     suspected.empty() ? "suspected counts of the sensor"
                     : is_known        ? suspected
                                       : suspected + ", or counts of the sensor");
}

std::string doubt_of_com(const PayloadEstimate& found, const Payload& expected) {
  const double distance = found.com.norm(), drawn = expected.com.norm();
  constexpr double kLeast = 0.005;    // m; less is within the errors of a drawing
  constexpr double kFarther = 100.0;  // times as far as in device.yaml
  const bool is_far = distance > kHeld;
  const bool is_farther = expected.mass > 0.0 && distance > kFarther * std::max(drawn, kLeast);
  if (!is_far && !is_farther) return "";
  const std::string suspected = suspected_unit(
      distance, {0.0, is_farther ? kFarther * std::max(drawn, kLeast) : kHeld}, kOtherTorques, "m");
  return fmt::format(
      "n: the centre of mass is {:.3g} m from the sensor, {}{}", distance,
      is_far ? "farther than what a person holds" : fmt::format("in device.yaml {:.3g} m", drawn),
      suspected.empty() ? "" : "; " + suspected);
}

}  // namespace

std::string acceleration_fault(std::span<const StaticPose> poses) {
  if (poses.empty()) return "";
  std::vector<double> sizes;
  for (const StaticPose& pose : poses) sizes.push_back(pose.a_S.norm());
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  if (around(kGravity).contains(*middle)) return "";
  constexpr std::array kOthers = {OtherUnit{"g", kGravity}, OtherUnit{"mg", 1e-3 * kGravity},
                                  OtherUnit{"cm/s^2", 1e-2}, OtherUnit{"mm/s^2", 1e-3}};
  const std::string suspected = suspected_unit(*middle, around(kGravity), kOthers, "m/s^2");
  return fmt::format("a: {:.4g} m/s^2 in the middle of the poses, expected {:g} at rest{}", *middle,
                     kGravity, suspected.empty() ? "" : "; " + suspected);
}

std::vector<std::string> payload_doubts(const PayloadEstimate& found, const Payload& expected) {
  std::vector<std::string> doubts;
  for (const std::string& doubt :
       {doubt_of_mass(found.mass, expected.mass), doubt_of_com(found, expected)}) {
    if (!doubt.empty()) doubts.push_back(doubt);
  }
  return doubts;
}

}  // namespace hg::identify

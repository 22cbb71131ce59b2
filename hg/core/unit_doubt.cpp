#include "hg/core/unit_doubt.h"

#include <cmath>

#include "hg/core/text.h"

namespace hg {
namespace {

constexpr int kDigits = 4;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kMostAngle = 4.0 * kTurn;  // arms wind up by two turns at most, wrists by four
constexpr double kMostLength = 60.0;        // m, of a hall with its crane
constexpr double kLeastRound = 15.0;        // +-10 rad stand for "no limit" in some files
constexpr double kMostSpeed = 60.0;         // rad/s; the fastest wrists and legs reach 52
constexpr double kLeastRoundSpeed = 30.0;   // rad/s; the fastest arms reach 26
constexpr double kRounding = 0.05;  // rad, of whole half turns with one digit after the point

bool is_multiple(double value, double of) noexcept {
  return std::abs(value / of - std::round(value / of)) < 1e-9;
}

std::string sentence(double value, const char* is, const std::string& suspected) {
  return to_text(value, kDigits) + is + "; " + suspected;
}

}  // namespace

std::string suspected_unit(double value, const Interval& plausible,
                           std::span<const OtherUnit> others, const char* unit) {
  std::string text;
  if (!std::isfinite(value) || plausible.contains(value)) return text;
  for (const OtherUnit& other : others) {
    const double mended = value * other.size;
    if (!plausible.contains(mended)) continue;
    text += (text.empty() ? "suspected " : ", or ") + std::string(other.name) + ": " +
            to_text(mended, kDigits) + " " + unit;
  }
  return text;
}

std::string after_semicolon(const std::string& suspected) {
  return suspected.empty() ? "" : "; " + suspected;
}

bool is_odd_angle(double angle) noexcept {
  const double size = std::abs(angle);
  if (!std::isfinite(size)) return false;
  const double off = std::abs(std::remainder(size, std::numbers::pi));
  if (off <= kRounding && !is_multiple(size, 1.0)) return false;
  return size > kMostAngle || (size >= kLeastRound && is_multiple(size, 5.0));
}

bool is_power_of_ten(double value) noexcept { return is_multiple(std::log10(value), 1.0); }

bool is_odd_speed(double speed) noexcept {
  if (!std::isfinite(speed) || speed < kLeastRoundSpeed) return false;
  if (is_power_of_ten(speed) || is_power_of_ten(2.0 * speed)) return false;
  return speed >= kMostSpeed || is_multiple(speed, 5.0);
}

std::string doubt_of_angle(double angle) {
  if (!is_odd_angle(angle)) return "";
  return sentence(angle,
                  (" rad are " + to_text(std::abs(angle) / kTurn, kDigits) + " turns").c_str(),
                  "suspected degrees: " + to_text(angle * kDegree, kDigits) + " rad");
}

std::string doubt_of_orientation(double angle) {
  constexpr double kRounded = 1.01;
  const std::string suspected =
      suspected_unit(angle, {-kRounded * kTurn, kRounded * kTurn}, kOtherAngles, "rad");
  return suspected.empty() ? "" : sentence(angle, " rad are more than a turn", suspected);
}

std::string doubt_of_speed(double speed) {
  if (!is_odd_speed(speed)) return "";
  return sentence(speed,
                  (" rad/s are " + to_text(speed / kTurn, kDigits) + " turns per second").c_str(),
                  suspected_unit(speed, {0.0, kLeastRoundSpeed}, kOtherSpeeds, "rad/s"));
}

std::string doubt_of_length(double length) {
  const std::string suspected =
      suspected_unit(length, {-kMostLength, kMostLength}, kOtherLengths, "m");
  return suspected.empty() ? "" : sentence(length, " m are more than a hall is long", suspected);
}

}  // namespace hg

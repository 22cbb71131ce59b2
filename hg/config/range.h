/// Allowed values of numbers in configuration files, and the units in their keys.
///
/// Keys end in their unit: `q_max_rad`, `stiffness_N_per_m`; a key without a known suffix has no
/// unit. A unit bounds its values to those of any plausible machine; a description narrows that
/// where a key needs it, and must do so where there is no unit.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "hg/core/interval.h"

namespace hg::config {

enum class Need { kOptional, kRequired };

/// Range of a number as given by a description; the unit of its key adds its own bounds.
struct Range {
  double lb = -kInfinity;
  double ub = kInfinity;
  /// Excludes lb 0: a positive number, at least the smallest of its unit
  bool excludes_lb = false;
  bool allows_infinity = false;  ///< ".inf" stands for "no limit"
};

/// Marks a number without default: it counts only when given.
inline constexpr double kNoDefault = std::numeric_limits<double>::quiet_NaN();

inline constexpr Range kAnyNumber = {};
inline constexpr Range kPositive = {.lb = 0.0, .excludes_lb = true};
inline constexpr Range kNotNegative = {.lb = 0.0};
inline constexpr Range kUnlimited = {.allows_infinity = true};
inline constexpr Range kPositiveOrNone = {.lb = 0.0, .excludes_lb = true, .allows_infinity = true};

// ranges of numbers without a unit
inline constexpr Range kFactor = {.lb = 1e-3, .ub = 1e3};     ///< true value over assumed value
inline constexpr Range kTolerance = {.lb = 1e-6, .ub = 1e6};  ///< share or multiple of a rating
inline constexpr Range kFromOne = {.lb = 1.0, .ub = 1e6};     ///< multiple of a rating
inline constexpr Range kShare = {.lb = 0.0, .ub = 1e3};       ///< share of a full scale or a load
inline constexpr Range kShareOrNone = {.lb = 1e-6, .ub = 1e3, .allows_infinity = true};
inline constexpr Range kCount = {.lb = 0.0, .ub = 1e6};
/// Position of a joint in rad or m, under a key that is its name.
inline constexpr Range kJointPosition = {.lb = -1e3, .ub = 1e3};

/// The allowed values of a number: finite ends always, NaN never.
class Bounds {
 public:
  /// Intersects `range` with what the unit of `key` allows. Throws std::logic_error if an end
  /// remains open: the description must give it.
  Bounds(const Range& range, std::string_view key);

  bool contains(double value) const noexcept;
  /// The bounds as text, for example "0 .. 1" or "1e-09 .. 1000 or .inf".
  std::string text() const;

 private:
  double lb_, ub_;
  bool allows_infinity_;
};

/// Unit named by a key: "rad/s^2" for "ddq_max_rad_per_s2"; empty if there is none.
std::string_view unit_of(std::string_view key) noexcept;

/// Kind of unit of a joint's position; kEither stands for any joint on the reference page.
enum class JointUnit { kAngle, kLength, kEither };

/// The two spellings of a key that belongs to a joint: rad family and m family.
struct JointKey {
  std::string_view angle;
  std::string_view length;

  std::string_view of(JointUnit unit) const noexcept {
    return unit == JointUnit::kLength ? length : angle;
  }
};

/// One name of a choice and the value it stands for.
template <class T>
struct Choice {
  std::string_view name;
  T value;
};
template <class T>
using Choices = std::span<const Choice<std::type_identity_t<T>>>;

}  // namespace hg::config

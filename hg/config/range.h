/// What a number in a configuration file may be, and the unit that its key carries.
///
/// Keys end in their unit: `q_max_rad`, `stiffness_N_per_m`; a key without a known suffix has no
/// unit.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "hg/core/interval.h"

namespace hg::config {

enum class Need { kOptional, kRequired };

/// Allowed values of one number; NaN never is.
struct Range {
  double lb = -kInfinity;
  double ub = kInfinity;
  bool excludes_lb = false;
  bool allows_infinity = false;  ///< ".inf" stands for "no limit"
};

/// Default of a number that has none: it only counts when it is given.
inline constexpr double kNoDefault = std::numeric_limits<double>::quiet_NaN();

inline constexpr Range kAnyNumber = {};
inline constexpr Range kPositive = {.lb = 0.0, .excludes_lb = true};
inline constexpr Range kNotNegative = {.lb = 0.0};
inline constexpr Range kUnlimited = {.allows_infinity = true};
inline constexpr Range kPositiveOrNone = {.lb = 0.0, .excludes_lb = true, .allows_infinity = true};

bool contains(const Range& range, double value) noexcept;

/// For example "> 0", "0 .. 1" or "finite".
std::string to_text(const Range& range);

/// "rad/s^2" for "ddq_max_rad_per_s2"; empty if the key names no unit.
std::string_view unit_of(std::string_view key) noexcept;

/// What a joint's position is measured in; kEither stands for any joint on the reference page.
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

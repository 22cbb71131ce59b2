/// The rule by which everything that is planned for a time of a run acts.
#pragma once

namespace hg {

/// Whether something planned for `at_s` acts in the cycle that begins at `time_s`: in the first
/// cycle at or after it, and later. Both in s; rounding of the cycle's time delays nothing.
inline bool is_due(double at_s, double time_s) noexcept {
  constexpr double kRounding = 1e-9;  // s
  return at_s <= time_s + kRounding;
}

/// Whether the cycle that begins at `time_s` is within the interval of `for_s` from `from_s` on,
/// all in s; `for_s` = 0: until the end of the run.
inline bool is_within(double from_s, double for_s, double time_s) noexcept {
  return is_due(from_s, time_s) && (for_s == 0.0 || !is_due(from_s + for_s, time_s));
}

}  // namespace hg

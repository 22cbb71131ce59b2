#include "hg/experiments/decay.h"

#include <algorithm>
#include <cmath>

namespace hg::experiments {
namespace {

std::size_t count_of(double seconds, double rate_Hz) { return std::llround(seconds * rate_Hz); }

}  // namespace

std::string_view to_string(DecayClass verdict) noexcept {
  switch (verdict) {
    case DecayClass::kStable:
      return "stable";
    case DecayClass::kSlow:
      return "slow decay";
    case DecayClass::kHunts:
      return "hunts";
    case DecayClass::kSustained:
      return "sustained";
    case DecayClass::kDiverges:
      return "diverges";
  }
  return "unknown";
}

DecayClass judge_decay(std::span<const double> speed, const CalmRule& rule, double rate_Hz) {
  const std::size_t window = count_of(rule.window, rate_Hz);
  const auto largest = [](std::span<const double> part) { return *std::ranges::max_element(part); };
  const double before = largest(speed.subspan(window, window));
  const double last = largest(speed.last(window));
  if (last <= rule.calm_speed) return DecayClass::kStable;
  if (last > rule.growing * before) return DecayClass::kDiverges;
  return last > rule.sustained * before ? DecayClass::kSustained : DecayClass::kSlow;
}

}  // namespace hg::experiments

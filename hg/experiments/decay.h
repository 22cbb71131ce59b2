/// Decay of a motion after a kick: at rest, slow, sustained or growing. Source: [C] 3.
#pragma once

#include <span>
#include <string_view>

namespace hg::experiments {

/// Decay of a handle's motion after a kick, classified as in [C] 3.
enum class DecayClass {
  kStable,     ///< at rest in time
  kSlow,       ///< decays, but is not at rest in time
  kHunts,      ///< continues, but only because of friction: the joints stick and slip
  kSustained,  ///< continues with constant amplitude
  kDiverges,   ///< grows, loses the reference, or ends in a fault
};

std::string_view to_string(DecayClass verdict) noexcept;
/// Whether the motion comes to rest. Continued motion counts as unstable even if only friction
/// sustains it.
constexpr bool is_stable(DecayClass verdict) noexcept {
  return verdict == DecayClass::kStable || verdict == DecayClass::kSlow;
}

/// Rule for a handle at rest. [C] 3 looks at 2 s; a heavy body on a soft hand swings too slowly for
/// that.
struct CalmRule {
  double window = 1.0;       ///< window whose largest speed counts, s
  double calm_speed = 6e-3;  ///< speed below which the handle is at rest, m/s; [C] 3
  /// Ratio of last to second window from which the motion does not decay, [A]
  double sustained = 0.7;
  double growing = 1.5;  ///< ratio of last to second window from which the motion grows, [A]
};

/// Judges the speeds after a kick, at least three windows long. The first window, with the kick,
/// does not count; the last one does. Never kHunts: that takes a second kick.
DecayClass judge_decay(std::span<const double> speed, const CalmRule& rule, double rate_Hz);

}  // namespace hg::experiments

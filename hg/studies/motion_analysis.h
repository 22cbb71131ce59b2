/// Force and vibration felt by a hand, from true motion and true force of the handle: pure
/// functions.
///
/// Source: [HANDBOOK] 7 (Haptify's metrics), [C] 3 and 4. SI units; samples at a fixed rate.
#pragma once

#include <complex>
#include <span>
#include <string_view>
#include <vector>

#include "hg/core/types.h"

namespace hg::studies {

/// One sample of the handle, everything in B.
struct HandleSample {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< position
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< velocity
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  ///< acceleration
  Eigen::Vector3d f = Eigen::Vector3d::Zero();  ///< force of the person
};

/// The body that the handle should feel like.
struct FreeTwin {
  double mass = 6.0;     ///< kg
  double damping = 4.0;  ///< Ns/m
};

struct Feel {
  double force = 0.0;         ///< mean |f|, N
  double own_share = 0.0;     ///< mean |m a + b v| of the true motion, below kForceBand, N
  double extra = 0.0;         ///< mean |f - (m a + b v)|, below kForceBand, N
  double vibration_5 = 0.0;   ///< rms of the acceleration above 5 Hz, m/s^2
  double vibration_20 = 0.0;  ///< rms of the acceleration above 20 Hz, m/s^2
  double centroid_Hz = 0.0;   ///< frequency of spectral_centroid(), Hz
};

/// Upper end of what counts as force, Hz. [HANDBOOK] 7; with it the figures of [C] 4, which gives
/// none, fit each other: 6 kg times its acceleration between 5 and 20 Hz is its extra force.
inline constexpr double kForceBand = 20.0;

/// Evaluates a motion; the first `settling` seconds serve only the filters.
Feel feel(std::span<const HandleSample> motion, const FreeTwin& twin, double rate_Hz,
          double settling);

/// Mean frequency of the acceleration between 20 and 500 Hz, weighted with its magnitude over all
/// axes ([HANDBOOK] 7: DFT321, Welch with Hann windows of 0.5 s); 0 for less than one window.
double spectral_centroid(std::span<const HandleSample> motion, double rate_Hz);

/// Complex amplitude of x(t) at a frequency; `x` should last a whole number of its periods.
std::complex<double> phasor(std::span<const double> x, double frequency_Hz, double rate_Hz);

/// Decay of a handle's motion after a kick, classified as in [C] 3.
enum class Verdict {
  kStable,     ///< at rest in time
  kSlow,       ///< decays, but is not at rest in time
  kHunts,      ///< continues, but only because of friction: the joints stick and slip
  kSustained,  ///< continues with constant amplitude
  kDiverges,   ///< grows, loses the reference, or ends in a fault
};

/// Symbol of a verdict: '.', 'r', 'h', 'U', 'X'.
char symbol(Verdict verdict) noexcept;
std::string_view to_string(Verdict verdict) noexcept;
/// Whether the motion comes to rest. Continued motion counts as unstable even if only friction
/// sustains it.
constexpr bool is_stable(Verdict verdict) noexcept {
  return verdict == Verdict::kStable || verdict == Verdict::kSlow;
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
Verdict judge_decay(std::span<const double> speed, const CalmRule& rule, double rate_Hz);

}  // namespace hg::studies

/// Physiological tremor: band-limited noise of 8-12 Hz. Source: [HANDBOOK] 5.1.
#pragma once

#include <array>
#include <cstdint>

#include "hg/core/types.h"

namespace hg::person {

/// Sum of sines with frequencies and phases drawn from the seed: nothing lies outside the band, and
/// the force is a pure function of time. No allocation, noexcept.
class Tremor {
 public:
  /// `rms`: RMS force along each axis, N.
  Tremor(double rms, std::uint64_t seed) noexcept;

  /// Force at time `t`, N.
  Eigen::Vector3d force(double t) const noexcept;

 private:
  static constexpr int kSines = 8;  ///< sines per axis: 2 per Hz of the band
  struct Sine {
    double omega = 0.0, phase = 0.0;  ///< rad/s, rad
  };
  double amplitude_;
  std::array<std::array<Sine, kSines>, 3> sines_;
};

}  // namespace hg::person

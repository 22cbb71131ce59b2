/// What a person would feel of a linear loop around the handle: pure functions of a HandleLoop.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "hg/tuning/handle_loop.h"

namespace hg::tuning {

/// Of one posture.
struct Feel {
  /// Up to here the felt impedance is within 3 dB of the body's, along each axis of H, Hz.
  std::array<double, 3> transparency_Hz{};
  /// By how much the motion is later than the body's would be under the same force, along each
  /// axis of H, at kLatencyAt, s.
  std::array<double, 3> latency_s{};
  /// Mean of |1 - felt / body| from 1 to 20 Hz on a logarithmic axis, of the worst axis.
  double distortion = 0.0;
  /// What the hand feels beside the body where friction is not what the controller believes: mean
  /// amplitude from 0.5 to 8 Hz, N.
  double friction_N = 0.0;
  double vibration = 0.0;    ///< rms of the handle's acceleration above 20 Hz, m/s^2
  double centroid_Hz = 0.0;  ///< of its spectrum from 20 to 500 Hz, weighted with the amplitude

  double least_transparency_Hz() const;
  double largest_latency_s() const;
};

inline constexpr double kLatencyAt = 3.0;  ///< Hz

/// Felt impedance over that of the body along the axes of H, at one frequency; 1 = nothing but the
/// body is felt. `resolvent`: of `loop.A`.
std::array<std::complex<double>, 3> felt_over_body(Resolvent& resolvent, const HandleLoop& loop,
                                                   const Body& body, double frequency_Hz);

/// Source: [HANDBOOK] 7, as hg/haptify measures them in simulation.
/// `friction` (n): torques on the motors that nobody expects, Nm.
Feel feel(const HandleLoop& loop, const Body& body, const Eigen::VectorXd& friction);

}  // namespace hg::tuning

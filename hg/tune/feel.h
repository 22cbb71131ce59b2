/// Felt quality of a linear loop around the handle: pure functions of a HandleLoop.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "hg/handle_loop/handle_loop.h"

namespace hg::tune {

using handle_loop::Body;
using handle_loop::HandleLoop;
using handle_loop::Resolvent;

/// Felt quality in one posture.
struct Feel {
  /// Frequency up to which the felt impedance is within 3 dB of the body's, along each axis of H,
  /// Hz.
  std::array<double, 3> transparency_Hz{};
  /// Delay of the motion behind the body's under the same force, along each axis of H, at
  /// kLatencyAt, s.
  std::array<double, 3> latency_s{};
  /// Mean of |1 - felt / body| from 1 to 20 Hz on a logarithmic axis, of the worst axis.
  double distortion = 0.0;
  /// Force felt beside the body due to friction unknown to the controller: mean amplitude from 0.5
  /// to 8 Hz, N.
  double friction_N = 0.0;
  double vibration = 0.0;  ///< rms of the handle's acceleration above 20 Hz, m/s^2
  /// Centroid of its spectrum from 20 to 500 Hz, weighted with the amplitude
  double centroid_Hz = 0.0;

  double least_transparency_Hz() const;
  double largest_latency_s() const;
};

inline constexpr double kLatencyAt = 3.0;  ///< frequency at which latency is evaluated, Hz

/// Felt impedance over that of the body along the axes of H, at one frequency; 1 = only the body is
/// felt. `resolvent` is that of `loop.A`.
std::array<std::complex<double>, 3> felt_over_body(Resolvent& resolvent, const HandleLoop& loop,
                                                   const Body& body, double frequency_Hz);

/// Computes the felt quality after [HANDBOOK] 7, as experiments/haptify measures it in simulation.
/// `friction` (n): unmodelled friction torques on the motors, Nm.
Feel feel(const HandleLoop& loop, const Body& body, const Eigen::VectorXd& friction);

}  // namespace hg::tune

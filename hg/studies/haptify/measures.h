/// The measures of Haptify and its relatives: pure functions of recorded signals.
///
/// Source: [HANDBOOK] 7, after Fazlollahi and Kuchenbecker, T-RO 39(2), 2023, and Landin et al.
/// 2010 (DFT321). SI units; samples at a fixed rate.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

namespace hg::haptify {

/// Lowest frequency that counts as vibration, Hz; [HANDBOOK] 7.
inline constexpr double kVibrationBand = 20.0;
/// Ratio of two magnitudes that are 3 dB apart.
inline constexpr double kWithin3dB = 1.4125;

/// One signal with the energy of three at every frequency: |A|^2 = sum |A_i|^2, and the phase of
/// their sum.
std::vector<double> dft321(std::span<const Eigen::Vector3d> axes);

/// Edges of the bands into which vibration is split, Hz.
inline constexpr std::array<double, 5> kBandEdges = {kVibrationBand, 50.0, 100.0, 200.0, 500.0};

struct Vibration {
  double rms = 0.0;          ///< m/s^2
  double centroid_Hz = 0.0;  ///< mean frequency weighted with the magnitude, up to 500 Hz
  std::array<double, kBandEdges.size() - 1> band_rms{};  ///< rms of each band, m/s^2
};

/// Adds the white noise of a sensor to a signal: sigma = density sqrt(rate) along each axis
/// ([HANDBOOK] 4.5). The same seed gives the same noise.
std::vector<Eigen::Vector3d> with_noise(std::span<const Eigen::Vector3d> signal, double density,
                                        double rate_Hz, std::uint64_t seed);

/// Vibration of a handle from its acceleration: above kVibrationBand (Butterworth of fourth order
/// without phase), reduced by dft321(); its first and last quarter of a second, and up to a few
/// hundredths of it more, serve the filter only. Zero for less than 1.5 s.
Vibration vibration(std::span<const Eigen::Vector3d> acceleration, double rate_Hz);

/// f = inertia a + damping v + friction sign(v), for forces or torques.
struct DynamicFit {
  double inertia = 0.0;   ///< kg or kg m^2
  double damping = 0.0;   ///< Ns/m or Nms/rad
  double friction = 0.0;  ///< N or Nm
  double r2 = 0.0;        ///< share of the variance of f that the fit explains
};

/// Fits the dynamics by least squares; the three signals have the same length of at least 10 and
/// must move.
DynamicFit fit_dynamics(std::span<const double> f, std::span<const double> v,
                        std::span<const double> a);

struct Line {
  double slope = 0.0, offset = 0.0;
};

/// Fits y over x by least squares.
Line fit_line(std::span<const double> x, std::span<const double> y);

/// Complex amplitude of x(t) at a frequency, weighted with a Hann window: the rest of slow
/// transients does not leak into it. `x` should last a whole number of its periods, at least three.
std::complex<double> amplitude(std::span<const double> x, double frequency_Hz, double rate_Hz);

/// First frequency at which a ratio is more than `factor` times too large or too small, on
/// logarithmic axes between the two frequencies around it; the last frequency when it never is.
double bandwidth(std::span<const double> frequency_Hz, std::span<const double> ratio,
                 double factor);

/// Delay of `signal` behind `reference` in s: the shift with the least squared difference, up to
/// `most`; both of the same length.
double delay(std::span<const double> reference, std::span<const double> signal, double rate_Hz,
             double most);

}  // namespace hg::haptify

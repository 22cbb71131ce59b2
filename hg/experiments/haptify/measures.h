/// The measures of Haptify and its relatives: pure functions of recorded signals.
///
/// Source: [HANDBOOK] 7, after Fazlollahi and Kuchenbecker, T-RO 39(2), 2023, and Landin et al.
/// 2010 (DFT321). SI units; samples at a fixed rate.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "hg/experiments/free_twin.h"

namespace hg::haptify {

/// Lowest frequency that counts as vibration, Hz; [HANDBOOK] 7.
inline constexpr double kVibrationBand = 20.0;
/// Ratio of two magnitudes that are 3 dB apart.
inline constexpr double kWithin3dB = 1.4125;

/// Upper end of what counts as force, Hz. [HANDBOOK] 7; with it the figures of [C] 4, which gives
/// none, fit each other: 6 kg times its acceleration between 5 and 20 Hz is its extra force.
inline constexpr double kForceBand = 20.0;

/// One sample of the handle, everything in B.
struct HandleSample {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< velocity, m/s
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  ///< acceleration, m/s^2
  Eigen::Vector3d f = Eigen::Vector3d::Zero();  ///< force of the person, N
};

/// Force that a hand feels while it moves a free body; vibration() has what it feels above 20 Hz.
struct Feel {
  double force = 0.0;             ///< mean |f|, N
  double own_share = 0.0;         ///< mean |m a + b v| of the true motion, below kForceBand, N
  double extra = 0.0;             ///< mean |f - (m a + b v)|, below kForceBand, N
  double acceleration_5Hz = 0.0;  ///< rms of the acceleration above 5 Hz, m/s^2
};

/// Evaluates a motion; the first `settling` seconds serve only the filters.
Feel feel(std::span<const HandleSample> motion, const experiments::FreeTwin& twin, double rate_Hz,
          double settling);

/// Magnitude of a signal over frequency, by Welch's method with Hann windows of 0.5 s ([HANDBOOK]
/// 7): root of the power density summed over the axes, from 0 Hz in steps of step_Hz, in units of
/// the signal per sqrt(Hz). Empty for less than one window.
struct Spectrum {
  double step_Hz = 0.0;
  std::vector<double> magnitude;
};
Spectrum spectrum(std::span<const Eigen::Vector3d> signal, double rate_Hz);

/// Mean frequency of a spectrum between 20 and 500 Hz, weighted with its magnitude ([HANDBOOK] 7);
/// 0 for less than one window of spectrum().
double spectral_centroid(const Spectrum& spectrum);

/// Complex amplitude of x(t) at a frequency; `x` should last a whole number of its periods.
std::complex<double> phasor(std::span<const double> x, double frequency_Hz, double rate_Hz);

/// One signal with the energy of three at every frequency: |A|^2 = sum |A_i|^2, and the phase of
/// their sum.
std::vector<double> dft321(std::span<const Eigen::Vector3d> axes);

/// Edges of the bands into which vibration is split, Hz.
inline constexpr std::array<double, 5> kBandEdges = {kVibrationBand, 50.0, 100.0, 200.0, 500.0};

struct Vibration {
  double rms = 0.0;          ///< m/s^2
  double centroid_Hz = 0.0;  ///< mean frequency weighted with the magnitude, up to 500 Hz
  std::array<double, kBandEdges.size() - 1> band_rms{};  ///< rms of each band, m/s^2
  Spectrum spectrum;                                     ///< m/s^2/sqrt(Hz)
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

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Spectrum, step_Hz, magnitude)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DynamicFit, inertia, damping, friction, r2)

}  // namespace hg::haptify

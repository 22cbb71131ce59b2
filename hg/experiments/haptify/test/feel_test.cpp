// Force, acceleration and spectrum of a handle that swings.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "hg/experiments/haptify/measures.h"

namespace hg::haptify {
namespace {

constexpr double kRate = 1000.0;  // Hz
constexpr double kPi = std::numbers::pi;

double at(std::size_t i) { return static_cast<double>(i) / kRate; }

// A handle that swings along `axis` with this acceleration, held without force.
std::vector<HandleSample> swinging(double frequency_Hz, double amplitude, double seconds,
                                   int axis = 0) {
  const double omega = 2.0 * kPi * frequency_Hz;
  std::vector<HandleSample> motion(std::lround(seconds * kRate));
  for (std::size_t i = 0; i < motion.size(); ++i) {
    motion[i].a[axis] = amplitude * std::sin(omega * at(i));
    motion[i].v[axis] = -amplitude / omega * std::cos(omega * at(i));
  }
  return motion;
}

// The person exerts what moves a free body so, and `extra` upwards.
void pull(const experiments::FreeTwin& twin, double extra, std::vector<HandleSample>& motion) {
  for (HandleSample& now : motion) {
    now.f = twin.mass * now.a + twin.damping * now.v + extra * Eigen::Vector3d::UnitZ();
  }
}

double centroid(const std::vector<HandleSample>& motion) {
  std::vector<Eigen::Vector3d> acceleration;
  for (const HandleSample& now : motion) acceleration.push_back(now.a);
  return spectral_centroid(spectrum(acceleration, kRate));
}

TEST(SpectralCentroid, OfASineIsItsFrequencyWhateverItsAxis) {
  constexpr double kBins = 0.3;  // Hz: what the window spreads around a sine is symmetric
  for (const double frequency : {30.0, 97.0, 250.0}) {
    for (const int axis : {0, 2}) {
      EXPECT_NEAR(centroid(swinging(frequency, 1.0, 4.0, axis)), frequency, kBins);
    }
  }
}

TEST(SpectralCentroid, WeighsWithMagnitudeAndNotWithPower) {
  std::vector<HandleSample> motion = swinging(50.0, 3.0, 4.0);
  const std::vector<HandleSample> other = swinging(150.0, 1.0, 4.0, 1);
  for (std::size_t i = 0; i < motion.size(); ++i) motion[i].a += other[i].a;
  EXPECT_NEAR(centroid(motion), 75.0, 1.0);  // with power: 60 Hz
}

TEST(SpectralCentroid, IgnoresWhatIsBelow20Hz) {
  std::vector<HandleSample> motion = swinging(100.0, 0.1, 4.0);
  const std::vector<HandleSample> walk = swinging(2.0, 5.0, 4.0);
  for (std::size_t i = 0; i < motion.size(); ++i) motion[i].a += walk[i].a;
  EXPECT_NEAR(centroid(motion), 100.0, 1.0);
}

TEST(SpectralCentroid, NeedsOneWindow) {
  EXPECT_EQ(centroid(swinging(100.0, 1.0, 0.499)), 0.0);
  EXPECT_GT(centroid(swinging(100.0, 1.0, 0.5)), 0.0);
  EXPECT_EQ(centroid(std::vector<HandleSample>(1000)), 0.0);
}

TEST(Feel, AccelerationIsTheRmsAbove5Hz) {
  const double rms = 2.0 / std::numbers::sqrt2;
  const Feel fast = feel(swinging(100.0, 2.0, 5.0), {}, kRate, 1.0);
  EXPECT_NEAR(fast.acceleration_5Hz, rms, 0.01 * rms);
  const Feel between = feel(swinging(10.0, 2.0, 5.0), {}, kRate, 1.0);
  EXPECT_NEAR(between.acceleration_5Hz, rms, 0.04 * rms);
  EXPECT_LT(feel(swinging(0.5, 2.0, 5.0), {}, kRate, 1.0).acceleration_5Hz, 0.02 * rms);
}

TEST(Feel, ABodyThatIsTheTwinNeedsItsOwnShareAndNothingElse) {
  constexpr experiments::FreeTwin kTwin = {.mass = 3.0, .damping = 8.0};
  std::vector<HandleSample> motion = swinging(0.5, 1.0, 9.0);
  pull(kTwin, 0.0, motion);
  const Feel alone = feel(motion, kTwin, kRate, 1.0);
  // m a and b v in quadrature: mean of a rectified sine
  const double mean = 2.0 / kPi * std::hypot(3.0, 8.0 / kPi);
  EXPECT_NEAR(alone.force, mean, 1e-3 * mean);
  EXPECT_NEAR(alone.own_share, mean, 1e-3 * mean);
  EXPECT_NEAR(alone.extra, 0.0, 1e-9);

  pull(kTwin, 0.25, motion);
  const Feel more = feel(motion, kTwin, kRate, 1.0);
  EXPECT_NEAR(more.extra, 0.25, 1e-3);
  EXPECT_NEAR(more.own_share, mean, 1e-3 * mean);
  EXPECT_GT(more.force, mean);
}

TEST(Feel, ForceIsJudgedBelow20Hz) {
  constexpr double kMean = 2.0 / kPi * 6.0;  // N: of 6 kg at 1 m/s^2
  EXPECT_NEAR(feel(swinging(5.0, 1.0, 5.0), {6.0, 0.0}, kRate, 1.0).extra, kMean, 0.03 * kMean);
  EXPECT_LT(feel(swinging(80.0, 1.0, 5.0), {6.0, 0.0}, kRate, 1.0).extra, 0.08 * kMean);
}

TEST(Feel, TheBeginningDoesNotCount) {
  std::vector<HandleSample> motion(3000);
  for (std::size_t i = 0; i < 1000; ++i) motion[i].f.x() = 50.0;
  EXPECT_EQ(feel(motion, {}, kRate, 1.0).force, 0.0);
  EXPECT_NEAR(feel(motion, {}, kRate, 0.5).force, 10.0, 1e-9);
  EXPECT_EQ(feel(motion, {}, kRate, 3.0).force, 0.0);  // nothing is left
}

TEST(Phasor, IsAmplitudeAndPhaseOfOneFrequency) {
  std::vector<double> x(2000);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = 5.0 - 3.0 * std::cos(2.0 * kPi * 8.0 * at(i) + 0.4) +
           2.0 * std::cos(2.0 * kPi * 20.0 * at(i));
  }
  EXPECT_NEAR(std::abs(phasor(x, 8.0, kRate) - std::polar(3.0, 0.4 - kPi)), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(phasor(x, 20.0, kRate) - std::polar(2.0, 0.0)), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(phasor(x, 12.0, kRate)), 0.0, 1e-9);
}

TEST(Spectrum, HoldsTheSquareOfARms) {
  std::vector<Eigen::Vector3d> signal(4000);
  for (std::size_t i = 0; i < signal.size(); ++i) {
    signal[i] = 3.0 * std::sin(2.0 * kPi * 80.0 * at(i)) * Eigen::Vector3d(0.6, 0.0, 0.8);
  }
  const Spectrum result = spectrum(signal, kRate);
  double squares = 0.0;
  for (const double value : result.magnitude) squares += value * value * result.step_Hz;
  EXPECT_NEAR(squares, 4.5, 0.01);
  EXPECT_TRUE(spectrum(std::vector<Eigen::Vector3d>(499), kRate).magnitude.empty());
}

}  // namespace
}  // namespace hg::haptify

#include "hg/experiments/haptify/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "hg/workspace/survey.h"

namespace hg::haptify {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRate = 1000.0;  // Hz

double at(std::size_t i) { return static_cast<double>(i) / kRate; }

using Signal = std::vector<Eigen::Vector3d>;

Signal noise(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Signal signal(count);
  for (Eigen::Vector3d& value : signal) {
    for (int axis = 0; axis < 3; ++axis) value[axis] = random.next() - 0.5;
  }
  return signal;
}

Signal sine(double frequency_Hz, double amplitude, const Eigen::Vector3d& axis, double seconds) {
  Signal signal(std::lround(seconds * kRate));
  for (std::size_t i = 0; i < signal.size(); ++i) {
    signal[i] = amplitude * std::sin(2.0 * kPi * frequency_Hz * at(i)) * axis;
  }
  return signal;
}

// One bin of a discrete Fourier transform, as its definition says.
std::complex<double> bin(const std::vector<double>& x, std::size_t k) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(k * i % x.size());
    sum += x[i] * std::polar(1.0, -angle / static_cast<double>(x.size()));
  }
  return sum;
}

// Landin et al. 2010: what DFT321 is made to keep.
TEST(Dft321, KeepsTheEnergyOfEveryFrequency) {
  for (const std::size_t count : {64u, 210u, 331u}) {  // also odd and prime
    const Signal axes = noise(count, count);
    const std::vector<double> reduced = dft321(axes);
    ASSERT_EQ(reduced.size(), count);
    for (const std::size_t k : {std::size_t{1}, count / 5, count / 2 - 1}) {
      double energy = 0.0;
      std::complex<double> sum = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> one;
        for (const Eigen::Vector3d& value : axes) one.push_back(value[axis]);
        energy += std::norm(bin(one, k));
        sum += bin(one, k);
      }
      const std::complex<double> found = bin(reduced, k);
      EXPECT_NEAR(std::norm(found), energy, 1e-9 * energy) << count << " " << k;
      EXPECT_NEAR(std::abs(std::arg(found / sum)), 0.0, 1e-9) << count << " " << k;
    }
  }
}

TEST(Dft321, OfOneAxisIsThatAxis) {
  const Signal axis = sine(40.0, 2.0, Eigen::Vector3d::UnitY(), 0.25);
  const std::vector<double> reduced = dft321(axis);
  for (std::size_t i = 0; i < axis.size(); ++i) ASSERT_NEAR(reduced[i], axis[i].y(), 1e-9);
  EXPECT_TRUE(dft321({}).empty());
}

TEST(Vibration, OfASineHasItsRmsAndFrequencyWhateverItsDirection) {
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.6, 0, -0.8)}) {
    const Vibration found = vibration(sine(90.0, 0.5, axis, 4.0), kRate);
    EXPECT_NEAR(found.rms, 0.5 / std::numbers::sqrt2, 2e-3 * 0.5);
    EXPECT_NEAR(found.centroid_Hz, 90.0, 0.5);
  }
}

TEST(Vibration, AddsAxesInQuadrature) {
  Signal both = sine(60.0, 3.0, Eigen::Vector3d::UnitX(), 4.0);
  const Signal other = sine(140.0, 4.0, Eigen::Vector3d::UnitZ(), 4.0);
  for (std::size_t i = 0; i < both.size(); ++i) both[i] += other[i];
  EXPECT_NEAR(vibration(both, kRate).rms, 5.0 / std::numbers::sqrt2, 0.02);
}

// Butterworth of fourth order without phase: |H|^2 = (f/20)^8 / (1 + (f/20)^4)^2
TEST(Vibration, FallsOffBelow20Hz) {
  const double rms = 1.0 / std::numbers::sqrt2;
  EXPECT_NEAR(vibration(sine(20.0, 1.0, Eigen::Vector3d::UnitX(), 6.0), kRate).rms, 0.5 * rms,
              0.01 * rms);
  EXPECT_NEAR(vibration(sine(10.0, 1.0, Eigen::Vector3d::UnitX(), 6.0), kRate).rms, rms / 17.0,
              0.005 * rms);
  EXPECT_LT(vibration(sine(0.5, 1.0, Eigen::Vector3d::UnitX(), 6.0), kRate).rms, 1e-3);
  EXPECT_EQ(vibration(Signal(1499), kRate).rms, 0.0);
}

TEST(Vibration, IsSplitIntoBands) {
  Signal all = sine(35.0, 1.0, Eigen::Vector3d::UnitX(), 4.0);
  const double amplitudes[] = {2.0, 3.0, 4.0}, frequencies[] = {70.0, 150.0, 300.0};
  for (int k = 0; k < 3; ++k) {
    const Signal one = sine(frequencies[k], amplitudes[k], Eigen::Vector3d::UnitY(), 4.0);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] += one[i];
  }
  const Vibration found = vibration(all, kRate);
  double squares = 0.0;
  for (const double rms : found.band_rms) squares += rms * rms;
  EXPECT_NEAR(std::sqrt(squares), found.rms, 1e-3 * found.rms);
  // at 35 Hz the filter takes a tenth
  EXPECT_NEAR(found.band_rms[0] * std::numbers::sqrt2, 0.904, 0.01);
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_NEAR(found.band_rms[k] * std::numbers::sqrt2, amplitudes[k - 1], 0.03);
  }
}

// White noise has its centroid in the middle of 20 to 500 Hz, and three axes add in quadrature.
TEST(WithNoise, IsWhiteAndAsStrongAsTheSensorSays) {
  const Signal still(20'000, Eigen::Vector3d::Zero());
  const Vibration found = vibration(with_noise(still, 1e-3, kRate, 4), kRate);
  EXPECT_NEAR(found.rms, 1e-3 * std::sqrt(kRate * 3.0 * 480.0 / 500.0), 1e-3);
  EXPECT_NEAR(found.centroid_Hz, 260.0, 5.0);
  EXPECT_EQ(with_noise(still, 1e-3, kRate, 4)[7], with_noise(still, 1e-3, kRate, 4)[7]);
  EXPECT_NE(with_noise(still, 1e-3, kRate, 4)[7], with_noise(still, 1e-3, kRate, 5)[7]);
}

TEST(FitDynamics, FindsWhatTheForceIsMadeOf) {
  std::vector<double> f, v, a;
  for (std::size_t i = 0; i < 3000; ++i) {
    const double w = 2.0 * kPi * (0.5 + 0.3 * at(i));  // several speeds
    v.push_back(0.2 * std::sin(w * at(i)));
    a.push_back(0.2 * w * std::cos(w * at(i)));
    f.push_back(6.0 * a.back() + 4.0 * v.back() + (v.back() > 0.0 ? 0.3 : -0.3));
  }
  f[0] -= -0.3;  // at rest there is none
  const DynamicFit clean = fit_dynamics(f, v, a);
  EXPECT_NEAR(clean.inertia, 6.0, 1e-9);
  EXPECT_NEAR(clean.damping, 4.0, 1e-9);
  EXPECT_NEAR(clean.friction, 0.3, 1e-9);
  EXPECT_NEAR(clean.r2, 1.0, 1e-9);

  // noise as large as the force itself is half of its variance
  double mean = 0.0, variance = 0.0;
  for (const double value : f) mean += value / static_cast<double>(f.size());
  for (const double value : f)
    variance += (value - mean) * (value - mean) / static_cast<double>(f.size());
  Random random(5);
  for (double& value : f) value += std::sqrt(12.0 * variance) * (random.next() - 0.5);
  const DynamicFit noisy = fit_dynamics(f, v, a);
  EXPECT_NEAR(noisy.inertia, 6.0, 0.3);
  EXPECT_NEAR(noisy.r2, 0.5, 0.05);
}

TEST(FitLine, IsLeastSquares) {
  const std::vector<double> x = {0.0, 1.0, 2.0, 3.0}, y = {1.0, 3.0, 2.0, 5.0};
  const Line line = fit_line(x, y);  // by hand: 1.1 x + 1.1
  EXPECT_NEAR(line.slope, 1.1, 1e-12);
  EXPECT_NEAR(line.offset, 1.1, 1e-12);
  EXPECT_EQ(fit_line(std::vector<double>{2.0, 2.0}, std::vector<double>{1.0, 3.0}).slope, 0.0);
}

// f = m a + b v of a body that drifts besides: what Response makes of force and velocity.
TEST(Amplitude, GivesTheImpedanceOfABodyThatStillDrifts) {
  constexpr double kMass = 6.0, kDamping = 4.0, kFrequency = 5.0, kDrift = 0.7;  // 1/s
  const double w = 2.0 * kPi * kFrequency;
  std::vector<double> v, f;
  for (std::size_t i = 0; i < 1000; ++i) {  // five periods
    const double drift = 0.2 * std::exp(-kDrift * at(i));
    const double swing = 0.05 * std::sin(w * at(i) + 0.4);
    v.push_back(swing + drift);
    f.push_back(kMass * (0.05 * w * std::cos(w * at(i) + 0.4) - kDrift * drift) +
                kDamping * v.back());
  }
  const std::complex<double> impedance =
      amplitude(f, kFrequency, kRate) / amplitude(v, kFrequency, kRate);
  const std::complex<double> body = {kDamping, w * kMass};
  EXPECT_NEAR(std::abs(impedance / body - 1.0), 0.0, 0.01);
}

TEST(Bandwidth, IsWhereTheRatioLeavesItsBand) {
  const std::vector<double> frequency = {1.0, 10.0, 100.0};
  EXPECT_EQ(bandwidth(frequency, std::vector<double>{1.0, 1.2, 0.8}, 1.4), 100.0);
  EXPECT_NEAR(bandwidth(frequency, std::vector<double>{1.0, 1.0, 2.0}, std::numbers::sqrt2),
              10.0 * std::sqrt(10.0), 1e-9);
  EXPECT_NEAR(bandwidth(frequency, std::vector<double>{1.0, 0.5, 1.0}, std::numbers::sqrt2),
              std::sqrt(10.0), 1e-9);  // also when it comes back
  EXPECT_EQ(bandwidth(frequency, std::vector<double>{3.0, 1.0, 1.0}, 1.4), 1.0);
}

TEST(Delay, IsFoundBetweenSamples) {
  const auto ramp = [](double t) { return t < 0.05 ? 0.0 : 1.0 - std::exp(-(t - 0.05) / 0.02); };
  std::vector<double> reference, signal;
  for (std::size_t i = 0; i < 300; ++i) {
    reference.push_back(ramp(at(i)));
    signal.push_back(ramp(at(i) - 0.0074));
  }
  EXPECT_NEAR(delay(reference, signal, kRate, 0.05), 0.0074, 1e-4);
  EXPECT_NEAR(delay(reference, reference, kRate, 0.05), 0.0, 1e-12);
}

}  // namespace
}  // namespace hg::haptify

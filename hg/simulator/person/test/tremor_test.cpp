#include "hg/simulator/person/tremor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

namespace hg::person {
namespace {

constexpr double kDt = 5e-3;    // s
constexpr int kSamples = 5000;  // 25 s

std::vector<double> samples(const Tremor& tremor, int axis) {
  std::vector<double> x;
  for (int i = 0; i < kSamples; ++i) x.push_back(tremor.force(i * kDt)[axis]);
  return x;
}

double mean_product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) sum += a[i] * b[i];
  return sum / kSamples;
}

// power between two frequencies, by Fourier sums of the windowed samples
double power(const std::vector<double>& x, double from_Hz, double to_Hz) {
  constexpr double kResolution = 1.0 / (kSamples * kDt);
  double sum = 0.0;
  for (double f = from_Hz; f < to_Hz; f += kResolution) {
    std::complex<double> line = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const double window = 1.0 - std::cos(2.0 * M_PI * i / kSamples);
      line += window * x[i] * std::polar(1.0, -2.0 * M_PI * f * i * kDt);
    }
    sum += std::norm(line);
  }
  return sum;
}

TEST(Tremor, LiesBetweenEightAndTwelveHertz) {
  for (const std::uint64_t seed : {1u, 2u, 77u}) {
    SCOPED_TRACE(seed);
    const std::vector<double> x = samples(Tremor(0.04, seed), static_cast<int>(seed % 3));
    const double inside = power(x, 8.0, 12.0);
    EXPECT_LT(power(x, 0.0, 7.8) + power(x, 12.2, 30.0), 1e-4 * inside);
    for (double f = 8.0; f < 12.0; f += 1.0) EXPECT_GT(power(x, f, f + 1.0), 0.1 * inside) << f;
  }
}

TEST(Tremor, HasItsStrengthAlongEachAxisAndNothingInCommon) {
  for (const std::uint64_t seed : {1u, 5u, 9u}) {
    SCOPED_TRACE(seed);
    const Tremor tremor(0.04, seed);
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<double> x = samples(tremor, axis), y = samples(tremor, (axis + 1) % 3);
      EXPECT_NEAR(std::sqrt(mean_product(x, x)), 0.04, 0.004);
      EXPECT_LT(std::abs(mean_product(x, y)), 0.3 * 0.04 * 0.04);
    }
  }
}

TEST(Tremor, IsDecidedByItsSeed) {
  const Tremor a(0.04, 3), same(0.04, 3), other(0.04, 4);
  EXPECT_EQ(a.force(1.23), same.force(1.23));
  EXPECT_GT((a.force(1.23) - other.force(1.23)).norm(), 1e-3);
}

TEST(Tremor, CanBeOff) { EXPECT_EQ(Tremor(0.0, 1).force(0.3), Eigen::Vector3d(0, 0, 0)); }

}  // namespace
}  // namespace hg::person

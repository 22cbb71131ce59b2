#include "hg/studies/haptify/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "hg/commissioning/checks/survey.h"

namespace hg::haptify {
namespace {

TEST(MeanOf, IsStudentsIntervalOfAKnownExample) {
  // NIST/SEMATECH e-Handbook 1.3.5.2, data set ZARR13: 195 values with mean 9.261460 and standard
  // deviation 0.022789 have the interval 9.258242 .. 9.264679; here as two values each side of it
  constexpr double kMean = 9.261460, kDeviation = 0.022789;
  constexpr int kCount = 195;
  std::vector<double> values = {kMean};
  for (int i = 0; i < (kCount - 1) / 2; ++i) {
    values.push_back(kMean - kDeviation);
    values.push_back(kMean + kDeviation);
  }
  const Mean mean = mean_of(values);
  EXPECT_EQ(mean.count, 195u);
  EXPECT_NEAR(mean.value, kMean, 1e-9);
  EXPECT_NEAR(mean.value - mean.half_width, 9.258242, 2e-6);
  EXPECT_NEAR(mean.value + mean.half_width, 9.264679, 2e-6);
}

TEST(MeanOf, OfFewValuesUsesTheTable) {
  const std::array<double, 5> values = {1.0, 2.0, 3.0, 4.0, 5.0};
  const Mean mean = mean_of(values);
  EXPECT_DOUBLE_EQ(mean.value, 3.0);
  EXPECT_NEAR(mean.half_width, 2.776 * std::sqrt(2.5 / 5.0), 1e-12);
}

TEST(MeanOf, OfOneValueHasNoWidthAndOfNoneNoValue) {
  const std::array<double, 1> one = {7.0};
  EXPECT_EQ(mean_of(one).value, 7.0);
  EXPECT_TRUE(std::isnan(mean_of(one).half_width));
  EXPECT_TRUE(std::isnan(mean_of({}).value));
}

TEST(StudentT, GoesOnBehindTheTableAsTablesDo) {
  // NIST/SEMATECH e-Handbook 1.3.6.7.2
  EXPECT_DOUBLE_EQ(student_t(1), 12.706);
  EXPECT_DOUBLE_EQ(student_t(30), 2.042);
  EXPECT_NEAR(student_t(31), 2.040, 6e-4);
  EXPECT_NEAR(student_t(60), 2.000, 6e-4);
  EXPECT_NEAR(student_t(100), 1.984, 6e-4);
  EXPECT_NEAR(student_t(1'000'000), 1.960, 6e-4);
}

TEST(MeanOf, HoldsTheTruthIn95OfAHundredCases) {
  constexpr int kCases = 4000, kCount = 5;
  checks::Random random(3);
  int held = 0;
  for (int i = 0; i < kCases; ++i) {
    std::vector<double> values;
    for (int k = 0; k < kCount; ++k) {
      double sum = -6.0;  // of twelve uniform numbers: nearly normal
      for (int j = 0; j < 12; ++j) sum += random.next();
      values.push_back(sum);
    }
    const Mean mean = mean_of(values);
    held += std::abs(mean.value) <= mean.half_width ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(held) / kCases, 0.95, 0.012);  // three standard deviations
}

}  // namespace
}  // namespace hg::haptify

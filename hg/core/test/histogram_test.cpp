#include "hg/core/histogram.h"

#include <gtest/gtest.h>

#include <limits>

#include "hg/core/interval.h"

namespace hg {
namespace {

TEST(Histogram, GivesMedianAndPercentileToOnePercentAndTheExactMaximum) {
  for (const double unit : {1e-7, 1.0, 1e5}) {
    Histogram histogram;
    for (int i = 1000; i >= 0; --i) histogram.add(unit * i);
    const Distribution d = histogram.distribution();
    EXPECT_NEAR(d.median, 500.0 * unit, 5.0 * unit);
    EXPECT_NEAR(d.p99_9, 999.0 * unit, 9.99 * unit);
    EXPECT_EQ(d.max, 1000.0 * unit);
  }
}

TEST(Histogram, TakesValuesOutsideItsBins) {
  EXPECT_EQ(Histogram().distribution().max, 0.0);
  Histogram histogram;
  histogram.add(0.0);
  histogram.add(std::numeric_limits<double>::quiet_NaN());
  histogram.add(kInfinity);
  EXPECT_EQ(histogram.distribution().median, 0.0);
  EXPECT_EQ(histogram.distribution().max, kInfinity);
}

TEST(Histogram, CountsWhatIsBelowABound) {
  Histogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.add(i);
  EXPECT_NEAR(static_cast<double>(histogram.below(100.0)), 99.0, 1.5);
  EXPECT_EQ(histogram.below(1e6), 1000u);
  EXPECT_EQ(histogram.below(0.5), 0u);
  EXPECT_EQ(histogram.count(), 1000u);
}

}  // namespace
}  // namespace hg

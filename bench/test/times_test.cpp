#include "bench/times.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace hg::bench {
namespace {

Times times_of(const std::vector<double>& us) {
  Times times;
  for (std::size_t i = 0; i < us.size(); ++i) times.add(i, us[i]);
  return times;
}

TEST(Times, TheFastestOfEachCounts) {
  Times times = times_of({3.0, 5.0});
  times.add(0, 4.0);
  times.add(1, 2.0);
  EXPECT_EQ(times.us(), (std::vector{3.0, 2.0}));
  EXPECT_EQ(times.mean(), 2.5);
}

TEST(Times, PercentilesAreExact) {
  std::vector<double> us(2000);
  std::iota(us.rbegin(), us.rend(), 1.0);
  const analysis::Distribution d = times_of(us).distribution();
  EXPECT_EQ(d.median, 1000.0);
  EXPECT_EQ(d.p99_9, 1998.0);
  EXPECT_EQ(d.max, 2000.0);
  EXPECT_EQ(Times().distribution().max, 0.0);
}

TEST(Times, OfFewerThanAThousandThereIsNoTail) {
  EXPECT_EQ(times_of(std::vector(1000, 2.0)).distribution().p99_9, 2.0);
  for (const std::size_t count : {0U, 999U}) {
    const analysis::Distribution d = times_of(std::vector(count, 2.0)).distribution();
    EXPECT_EQ(to_text(d.p99_9, 2), "-");
  }
}

TEST(Histogram, EveryTimeIsInTheBinThatHoldsIt) {
  const std::vector<Bin> bins = histogram(times_of({1.0, 1.01, 3.0, 0.2}));
  std::size_t count = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    count += bins[i].count;
    EXPECT_NEAR(bins[i].high / bins[i].low, std::pow(10.0, 0.05), 1e-9);
    EXPECT_EQ(bins[i].low, i > 0 ? bins[i - 1].high : bins[i].low);
  }
  EXPECT_EQ(count, 4u);
  EXPECT_LE(bins.front().low, 0.2);
  EXPECT_EQ(bins.front().count, 1u);
  EXPECT_GT(bins.back().high, 3.0);
  EXPECT_EQ(bins.back().count, 1u);
  EXPECT_TRUE(histogram({}).empty());
}

}  // namespace
}  // namespace hg::bench

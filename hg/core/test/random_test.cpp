#include "hg/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hg {
namespace {

TEST(Random, NumbersAreUniformAndRepeat) {
  Random random(1), same(1);
  double sum = 0.0, least = 1.0, most = 0.0;
  constexpr int kCount = 100'000;
  for (int i = 0; i < kCount; ++i) {
    const double number = random.next();
    ASSERT_EQ(number, same.next());
    sum += number;
    least = std::min(least, number);
    most = std::max(most, number);
  }
  EXPECT_GE(least, 0.0);
  EXPECT_LT(most, 1.0);
  EXPECT_NEAR(sum / kCount, 0.5, 4.0 / std::sqrt(12.0 * kCount));  // four standard deviations
}

// the engine is specified by the standard: the same everywhere
TEST(Random, FirstNumberOfASeedIsFixed) {
  EXPECT_EQ(Random(5489).next(), static_cast<double>(14514284786278117030ULL >> 11) * 0x1p-53);
}

TEST(Random, BetweenStaysInItsRange) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const double number = random.between(-3.0, 5.0);
    ASSERT_GE(number, -3.0);
    ASSERT_LT(number, 5.0);
  }
}

TEST(Random32, ShareIsTheNumberOfTheEngineInItsRange) {
  EXPECT_EQ(Random32(5489).share(), 3499211612.0 / 4294967295.0);
}

TEST(Random32, FirstNumbersOfASeedAreFixed) {
  EXPECT_EQ(Random32(5489).next(), (3499211612.0 + 0x1p32 * 581869302.0) * 0x1p-64);
  Random32 random(1);
  EXPECT_DOUBLE_EQ(random.normal(), -0.5497461789554496);  // by the same method in Python
  EXPECT_DOUBLE_EQ(random.normal(), -1.402872709127921);
}

#ifdef __GLIBCXX__
TEST(Random32, NumbersAreThoseOfTheDistributionsOfGcc) {
  Random32 random(3);
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.5, 4.0);
  for (int i = 0; i < 10'000; ++i) {
    ASSERT_EQ(random.normal(), normal(engine)) << i;
    if (i % 3 == 0) {
      ASSERT_EQ(random.between(-1.5, 4.0), uniform(engine)) << i;
    }
  }
}
#endif

}  // namespace
}  // namespace hg

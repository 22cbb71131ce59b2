#include "hg/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

TEST(Random, TenThousandthNumberOfThe32BitEngineIsThatOfTheStandard) {
  Random32 random(5489);
  for (int i = 1; i < 10'000; ++i) random.next();
  EXPECT_EQ(random.next(), 4123659995.0 / 4294967295.0);
}

TEST(Random, BetweenStaysInItsRange) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const double number = random.between(-3.0, 5.0);
    ASSERT_GE(number, -3.0);
    ASSERT_LT(number, 5.0);
  }
}

TEST(Random, NormalNumbersHaveMeanZeroAndVarianceOne) {
  Random random(3);
  constexpr int kCount = 100'000;
  double sum = 0.0, squares = 0.0, fourth = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double number = random.normal();
    sum += number;
    squares += number * number;
    fourth += std::pow(number, 4);
  }
  // four standard deviations
  EXPECT_NEAR(sum / kCount, 0.0, 4.0 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1.0, 4.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(fourth / kCount, 3.0, 4.0 * std::sqrt(96.0 / kCount));
}

}  // namespace
}  // namespace hg

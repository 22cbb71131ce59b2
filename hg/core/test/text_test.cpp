#include "hg/core/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace hg {
namespace {

TEST(Text, NumbersReadBackToTheSameValue) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, -2.5, 12345678.0}) {
    EXPECT_EQ(std::stod(to_text(value)), value);
  }
  EXPECT_EQ(to_text(0.1), "0.1");
}

TEST(Text, NumbersHaveTheDigitsThatPrintfWrites) {
  for (const double value : {0.0, -0.0, 1.0 / 3.0, 1234.5, 1e6, 1.25e-7, -1e300, HUGE_VAL}) {
    for (const int digits : {1, 3, 6, 15}) {
      char expected[64];
      std::snprintf(expected, sizeof expected, "%.*g", digits, value);
      EXPECT_EQ(to_text(value, digits), expected);
    }
  }
}

TEST(Text, QuotesAreSingle) { EXPECT_EQ(in_quotes("m1"), "'m1'"); }

}  // namespace
}  // namespace hg

#include "hg/core/text.h"

#include <gtest/gtest.h>

namespace hg {
namespace {

TEST(Text, NumbersReadBackToTheSameValue) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, -2.5, 12345678.0}) {
    EXPECT_EQ(std::stod(to_text(value)), value);
  }
  EXPECT_EQ(to_text(0.1), "0.1");
}

TEST(Text, QuotesAreSingle) { EXPECT_EQ(in_quotes("m1"), "'m1'"); }

}  // namespace
}  // namespace hg

#include "hg/config/schema.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace hg::config {
namespace {

TEST(Bounds, TheUnitOfAKeyGivesWhatItsRangeLeavesOpen) {
  EXPECT_EQ(Bounds(kAnyNumber, "z_m").text(), "-1000 .. 1000");
  EXPECT_EQ(Bounds(kNotNegative, "z_m").text(), "0 .. 1000");
  EXPECT_EQ(Bounds(kPositive, "mass_kg").text(), "1e-09 .. 1e+06");
  EXPECT_EQ(Bounds(kPositiveOrNone, "range_N").text(), "1e-06 .. 1e+07 or .inf");
  EXPECT_EQ(Bounds(kUnlimited, "q_max_rad").text(), "-1000 .. 1000, .inf or -.inf");
  EXPECT_EQ(Bounds({.lb = 0.5, .ub = 2.0}, "gain_1_per_s").text(), "0.5 .. 2");
  EXPECT_EQ(Bounds({.lb = 0.5, .ub = 1e300}, "mass_kg").text(), "0.5 .. 1e+06");
}

TEST(Bounds, WithoutAUnitTheDescriptionMustGiveBothEnds) {
  for (const Range& range : {kAnyNumber, kPositive, kNotNegative, kUnlimited, kPositiveOrNone}) {
    EXPECT_THROW(Bounds(range, "share"), std::logic_error);
  }
  for (const Range& range :
       {kFactor, kTolerance, kFromOne, kShare, kShareOrNone, kCount, kJointPosition}) {
    EXPECT_NO_THROW(Bounds(range, "share"));
  }
}

TEST(Bounds, ContainNoNaNAndOnlyTheInfinitiesThatAreAllowed) {
  const double nan = std::nan("");
  const Bounds position(kUnlimited, "q_max_rad"), speed(kPositiveOrNone, "dq_max_rad_per_s"),
      height(kAnyNumber, "z_m");
  for (const Bounds* bounds : {&position, &speed, &height}) EXPECT_FALSE(bounds->contains(nan));
  EXPECT_TRUE(position.contains(kInfinity) && position.contains(-kInfinity));
  EXPECT_TRUE(speed.contains(kInfinity));
  EXPECT_FALSE(speed.contains(-kInfinity));
  EXPECT_FALSE(height.contains(kInfinity));
  EXPECT_FALSE(height.contains(1e155) || height.contains(-1e155));
  EXPECT_FALSE(speed.contains(0.0) || speed.contains(1e-155));
}

TEST(Units, ACountPerSecondIsNoTime) {
  EXPECT_EQ(unit_of("overruns_per_s"), "1/s");
  EXPECT_EQ(unit_of("at_s"), "s");
  EXPECT_EQ(unit_of("overruns_in_a_row"), "");
}

}  // namespace
}  // namespace hg::config

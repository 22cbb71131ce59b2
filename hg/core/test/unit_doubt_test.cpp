#include "hg/core/unit_doubt.h"

#include <gtest/gtest.h>

namespace hg {
namespace {

TEST(UnitDoubt, NamesEveryUnitInWhichANumberIsPlausible) {
  const Interval shaft = {0.5, 10.0};
  EXPECT_EQ(suspected_unit(3.0, shaft, kOtherSpeeds, "rad/s"), "");
  EXPECT_EQ(suspected_unit(90.0, shaft, kOtherSpeeds, "rad/s"),
            "suspected degrees per second: 1.571 rad/s, or revolutions per minute: 9.425 rad/s");
  EXPECT_EQ(suspected_unit(1e6, shaft, kOtherSpeeds, "rad/s"), "");
  EXPECT_EQ(suspected_unit(kInfinity, shaft, kOtherSpeeds, "rad/s"), "");
}

TEST(UnitDoubt, AnglesOfJointsAreThoseThatAJointTurns) {
  EXPECT_EQ(doubt_of_angle(172), "172 rad are 27.37 turns; suspected degrees: 3.002 rad");
  EXPECT_EQ(doubt_of_angle(-90), "-90 rad are 14.32 turns; suspected degrees: -1.571 rad");
  for (const double odd : {15.0, -20.0, 27.0, 45.0, 88.0, 110.0, 180.0, 355.0, 360.0}) {
    EXPECT_TRUE(is_odd_angle(odd)) << odd;
  }
  // wrists, industrial arms, a screw of ten turns, and what some files have for "no limit"
  for (const double fair : {0.0, 3.05, -6.98, 9.25, 10.0, 62.83, 12.6, kInfinity}) {
    EXPECT_FALSE(is_odd_angle(fair)) << fair;
  }
}

TEST(UnitDoubt, WholeTurnsMayBeRounded) {
  for (const double fair : {31.42, 31.4, -62.8, 62.83, 125.7, 628.3}) {
    EXPECT_FALSE(is_odd_angle(fair)) << fair;
  }
}

TEST(UnitDoubt, OrientationsHaveOneTurn) {
  EXPECT_EQ(doubt_of_orientation(6.28), "");
  EXPECT_EQ(doubt_of_orientation(-4.712), "");
  EXPECT_EQ(doubt_of_orientation(90), "90 rad are more than a turn; suspected degrees: 1.571 rad");
}

TEST(UnitDoubt, SpeedsAreThoseOfTheFastestJoints) {
  EXPECT_EQ(doubt_of_speed(180),
            "180 rad/s are 28.65 turns per second; suspected degrees per second: 3.142 rad/s, or "
            "revolutions per minute: 18.85 rad/s");
  for (const double odd : {30.0, 45.0, 61.0, 720.0}) EXPECT_TRUE(is_odd_speed(odd)) << odd;
  // quick wrists, legs, and what some files have for "no limit"
  for (const double fair : {3.14, 26.18, 28.6, 50.0, 52.4, 59.9, 100.0, 1000.0, kInfinity}) {
    EXPECT_FALSE(is_odd_speed(fair)) << fair;
  }
}

TEST(UnitDoubt, LengthsAreThoseOfAHall) {
  for (const double fair : {5.5, 40.0, -60.0}) EXPECT_EQ(doubt_of_length(fair), "");
  EXPECT_EQ(doubt_of_length(-650),
            "-650 m are more than a hall is long; suspected millimetres: -0.65 m");
}

}  // namespace
}  // namespace hg

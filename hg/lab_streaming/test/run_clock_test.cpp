#include "hg/lab_streaming/run_clock.h"

#include <gtest/gtest.h>

namespace hg::lab_streaming {
namespace {

constexpr double kPeriod_s = 1e-3;

// Samples from `begin` on, seen `late_s` and up to 5 ms more after they were made at a clock that
// is `offset_s` ahead; returns how often an offset was taken.
int see(RunClock& clock, int begin, int end, double offset_s, double late_s = 0.0) {
  int taken = 0;
  for (int i = begin; i < end; ++i) {
    const double delay_s = late_s + kPeriod_s * (i % 6);
    taken += clock.see(kPeriod_s * i, offset_s + kPeriod_s * i + delay_s) ? 1 : 0;
  }
  return taken;
}

TEST(RunClock, TakesTheOffsetOnceFromTheSampleWithTheSmallestDelay) {
  RunClock clock;
  EXPECT_EQ(see(clock, 0, 90, 1234.5), 0);
  EXPECT_FALSE(clock.is_known());
  EXPECT_EQ(see(clock, 90, 20000, 1234.5), 1);
  EXPECT_NEAR(clock.offset_s(), 1234.5, 1e-9);
}

TEST(RunClock, IsNotMisledByAnObserverThatIsLate) {
  RunClock clock;
  see(clock, 0, 2000, 10.0);
  // a pause of the observer, then it takes what has waited; the run went on
  EXPECT_EQ(see(clock, 2000, 2300, 10.0, 0.3), 0);
  EXPECT_EQ(see(clock, 2300, 5000, 10.0), 0);
  EXPECT_NEAR(clock.offset_s(), 10.0, 1e-9);
}

TEST(RunClock, IsTakenAgainAfterRunTimeHasStoodStill) {
  RunClock clock;
  see(clock, 0, 2000, 10.0);
  EXPECT_EQ(see(clock, 2000, 6000, 12.5), 1);
  EXPECT_NEAR(clock.offset_s(), 12.5, 1e-9);
}

TEST(RunClock, IgnoresShiftsThatAreLatenessOfTheComputer) {
  RunClock clock;
  see(clock, 0, 2000, 10.0);
  EXPECT_EQ(see(clock, 2000, 6000, 10.09), 0);
  EXPECT_NEAR(clock.offset_s(), 10.0, 1e-9);
}

TEST(RunClock, OfARunThatEndsEarlyIsTakenFromWhatThereIs) {
  RunClock clock;
  EXPECT_FALSE(clock.finish());  // no sample, no offset
  see(clock, 0, 50, 1234.5);
  EXPECT_TRUE(clock.finish());
  EXPECT_NEAR(clock.offset_s(), 1234.5, 1e-9);
  EXPECT_FALSE(clock.finish());
}

}  // namespace
}  // namespace hg::lab_streaming

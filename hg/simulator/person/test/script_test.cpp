#include "hg/simulator/person/script.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hg::person {
namespace {

Segment segment(double start_s, double duration_s, int channel, Blend blend, double value) {
  return {start_s, duration_s, channel, blend, value};
}

TEST(Script, MinimumJerkGoesFromZeroToOneWithoutSpeedAtTheEnds) {
  EXPECT_EQ(minimum_jerk(0.9, 1.0, 2.0), 0.0);
  EXPECT_EQ(minimum_jerk(3.1, 1.0, 2.0), 1.0);
  EXPECT_DOUBLE_EQ(minimum_jerk(2.0, 1.0, 2.0), 0.5);
  EXPECT_NEAR((minimum_jerk(2.001, 1.0, 2.0) - minimum_jerk(1.999, 1.0, 2.0)) / 0.002, 1.875 / 2.0,
              1e-5);
  EXPECT_NEAR(minimum_jerk(1.001, 1.0, 2.0), 0.0, 1e-8);
}

TEST(Script, SegmentsBlendToTheirTargetsAndAdd) {
  Script script;
  script.start[2] = -0.75;
  script.segments = {segment(1, 1, 2, Blend::kTo, -0.4), segment(3, 1, 2, Blend::kBy, 0.1)};
  EXPECT_DOUBLE_EQ(evaluate(script, 0.5)[2], -0.75);
  EXPECT_DOUBLE_EQ(evaluate(script, 2.5)[2], -0.4);
  EXPECT_DOUBLE_EQ(evaluate(script, 5.0)[2], -0.3);
}

TEST(Script, TheCircleTurnsPositionAndHeading) {
  Script script;
  script.start[0] = 0.9;
  script.start[3] = 0.5 * std::numbers::pi;
  script.segments = {segment(0, 10, 0, Blend::kCircle, 1.25)};
  const auto end = evaluate(script, 10.0);
  EXPECT_NEAR(end[0], 0.0, 1e-12);
  EXPECT_NEAR(end[1], 0.9, 1e-12);
  EXPECT_NEAR(end[3], 3.0 * std::numbers::pi, 1e-12);
  for (double t = 0; t < 10; t += 0.5) {
    const auto now = evaluate(script, t);
    EXPECT_NEAR(std::hypot(now[0], now[1]), 0.9, 1e-12);
  }
}

}  // namespace
}  // namespace hg::person

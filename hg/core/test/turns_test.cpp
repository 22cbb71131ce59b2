#include "hg/core/turns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hg {
namespace {

constexpr double kDt = 1e-3;

int turns_of(double frequency_Hz, double seconds, double least, double pause_s) {
  Turns turns;
  for (int n = 0; n < static_cast<int>(seconds / kDt); ++n) {
    const double x = std::sin(2.0 * std::numbers::pi * frequency_Hz * kDt * n);
    turns.step(Eigen::Vector3d(0.0, 3.0, 4.0) * x, least, kDt, pause_s);
  }
  return turns.count;
}

TEST(Turns, CountsHalfPeriods) {
  EXPECT_EQ(turns_of(10.0, 1.04, 1.0, 0.2), 20);
  EXPECT_EQ(turns_of(3.0, 1.1, 1.0, 0.2), 6);
}

TEST(Turns, IsResetByAPauseAndIgnoresSmallValues) {
  EXPECT_LE(turns_of(2.0, 5.1, 1.0, 0.2), 1);
  EXPECT_EQ(turns_of(10.0, 1.0, 5.1, 0.2), 0);
}

TEST(Turns, DoesNotCountAPushThatOnlyComesAndGoes) {
  Turns turns;
  for (int n = 0; n < 1000; ++n) {
    const double x = n % 100 < 50 ? 1.0 : 0.0;
    turns.step({x, 0.0, 0.0}, 0.1, kDt, 0.2);
  }
  EXPECT_EQ(turns.count, 0);
}

}  // namespace
}  // namespace hg

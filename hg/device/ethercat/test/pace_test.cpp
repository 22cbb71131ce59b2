#include "hg/device/ethercat/pace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace hg::ethercat {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;  // ns

// Clock of the first slave, which is faster than the computer's.
std::uint64_t slave_time(std::int64_t time_ns, double drift) {
  return static_cast<std::uint64_t>(std::llround(static_cast<double>(time_ns) * (1.0 + drift))) +
         123'456'789;
}

// Periods in which each frame is `late_ns` behind its time.
void run(Pace& pace, int periods, double drift, std::int64_t late_ns = 0) {
  for (int i = 0; i < periods; ++i) {
    const std::int64_t now = pace.due_ns() + late_ns;
    pace.advance(now);
    pace.follow(slave_time(now, drift));
  }
}

TEST(Pace, ComesIntoStepAndStaysThere) {
  for (const double drift : {0.0, 3e-4, -3e-4}) {
    Pace pace(5'000, kPeriod);
    EXPECT_FALSE(pace.is_settled());
    run(pace, 500, drift);
    EXPECT_TRUE(pace.is_settled());
    run(pace, 100'000, drift);
    EXPECT_TRUE(pace.is_settled());
    // 300 ns per period are corrected by an eighth of the error
    EXPECT_NEAR(static_cast<double>(pace.error_ns()), 0.0, 2500.0);
  }
}

TEST(Pace, IsMovedLittleByOneLateFrame) {
  Pace pace(0, kPeriod);
  run(pace, 500, 0.0);
  const std::int64_t due = pace.due_ns();
  run(pace, 1, 0.0, 400'000);
  EXPECT_LE(std::abs(pace.due_ns() - due - kPeriod), kPeriod / 100);
}

TEST(Pace, LeavesMissedPeriodsOut) {
  Pace pace(0, kPeriod);
  pace.advance(3 * kPeriod + 1);
  EXPECT_EQ(pace.due_ns(), 4 * kPeriod);
  pace.advance(4 * kPeriod);
  EXPECT_EQ(pace.due_ns(), 5 * kPeriod);
}

}  // namespace
}  // namespace hg::ethercat

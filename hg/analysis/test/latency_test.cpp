#include "hg/analysis/latency.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hg/core/random.h"

namespace hg::analysis {
namespace {

constexpr double kRate_Hz = 500.0;

/// Samples of an arm of six joints that moves to and fro, rad, s.
struct Motion {
  double delay = 0.0;       ///< of the joints after their commands
  double amplitude = 0.05;  ///< of the first joint; the others move half as far as the one before
  double noise = 5e-5;      ///< of the encoders
  std::uint64_t age = 1;    ///< of the command in effect, samples
  bool is_remote = false;
  std::uint64_t wrench_lasts = 1;  ///< samples for which the wrench stays the same
};

VectorM at(double t, const Motion& motion) {
  VectorM q(6);
  for (int i = 0; i < 6; ++i) {
    const double w = 2.0 * std::numbers::pi * (0.5 + 0.1 * i);
    q[i] =
        3.1 + motion.amplitude * std::pow(0.5, i) * (std::sin(w * t) + 0.3 * std::sin(2.7 * w * t));
  }
  return q;
}

void feed(LatencyWatch& watch, const Motion& motion, double duration, Mode mode = Mode::kRunning) {
  Random32 random(3);
  const auto n = static_cast<std::uint64_t>(duration * kRate_Hz);
  for (std::uint64_t k = 1; k <= n; ++k) {
    const double t = static_cast<double>(k) / kRate_Hz;
    Sample sample;
    sample.record.cycle = sample.sensors.sequence = k;
    sample.record.mode = mode;
    sample.command.enable = true;
    sample.command.q_m = at(t + 1.0 / kRate_Hz, motion);  // where it is to be after one period
    sample.sensors.q_m = at(t - motion.delay, motion);
    for (double& q : sample.sensors.q_m) {
      q += motion.noise * random.normal();
      q = std::remainder(q + 2e-3, 2.0 * std::numbers::pi);  // sags, and is wrapped
    }
    sample.sensors.answered_sequence = k > motion.age ? k - motion.age : 0;
    sample.sensors.w_S[0] = static_cast<double>(k / motion.wrench_lasts);
    sample.truth.is_known = !motion.is_remote;
    watch.add(sample);
  }
}

TEST(Latency, TheDelayOfDrivesIsFoundFromTheMotionOfTheArm) {
  for (const double delay : {0.0, 0.008, 0.058, 0.16, 0.3}) {
    LatencyWatch watch(kRate_Hz, true);
    feed(watch, {.delay = delay}, 10.0);
    EXPECT_NEAR(watch.latency().drive, delay, 1e-3);
    EXPECT_LT(watch.latency().drive_spread, 2e-3);
  }
}

TEST(Latency, TheLinkIsNotCountedWithTheDrives) {
  LatencyWatch watch(kRate_Hz, true);
  EXPECT_FALSE(std::isfinite(watch.latency().link));
  feed(watch, {.delay = 0.078, .is_remote = true}, 10.0);
  EXPECT_TRUE(watch.latency().drive_has_link);
  EXPECT_NEAR(watch.latency().drive, 0.078, 2e-3);
  watch.add_link(0.02);
  EXPECT_FALSE(watch.latency().drive_has_link);
  EXPECT_NEAR(watch.latency().link, 0.02, 1e-6);
  EXPECT_NEAR(watch.latency().drive, 0.058, 2e-3);
}

TEST(Latency, DrivesThatGiveTorquesSayWhichCommandIsInEffect) {
  LatencyWatch watch(kRate_Hz, false);
  feed(watch, {.age = 11}, 3.0);
  EXPECT_NEAR(watch.latency().drive, 0.022, 1e-3);
  EXPECT_FALSE(watch.latency().needs_motion);
}

TEST(Latency, WithoutMotionTheDelayOfDrivesIsNotKnown) {
  LatencyWatch still(kRate_Hz, true), off(kRate_Hz, true);
  feed(still, {.delay = 0.05, .amplitude = 1e-5}, 10.0);
  feed(off, {.delay = 0.05}, 10.0, Mode::kReady);
  for (const LatencyWatch* watch : {&still, &off}) {
    EXPECT_FALSE(std::isfinite(watch->latency().drive));
    EXPECT_NE(to_text(watch->latency()).find("not enough motion"), std::string::npos);
    EXPECT_FALSE(to_json(watch->latency()).contains("drive_s"));
  }
}

TEST(Latency, ASensorThatIsSlowerThanTheLoopGivesOldValues) {
  LatencyWatch watch(kRate_Hz, true);
  feed(watch, {.wrench_lasts = 21}, 5.0);
  EXPECT_NEAR(watch.latency().sensor, 0.02, 2e-3);
}

TEST(Latency, IsOneLine) {
  const Latency latency{
      .link = 0.0204, .drive = 0.0581, .drive_spread = 0.0011, .sensor = 0.0012, .page = 0.2};
  EXPECT_EQ(to_text(latency),
            "link 20 ms there and back, drive 58 ms +- 1.1, sensor 1.2 ms, "
            "page 200 ms there and back");
  EXPECT_EQ(to_json(latency)["page_round_trip_s"], 0.2);
  EXPECT_EQ(to_text(Latency{}), "");
}

}  // namespace
}  // namespace hg::analysis

#include "hg/analysis/events.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hg::analysis {
namespace {

CycleRecord record_at(double time_s, Mode mode = Mode::kRunning) {
  CycleRecord record;
  record.mode = mode;
  record.time_s = time_s;
  record.reference.q_m = VectorM::Zero(6);
  return record;
}

TEST(EventDetector, TimeElapsesFromTheFirstRunningCycleOn) {
  EventDetector detector({{"late", "", {{.kind = ConditionKind::kElapsed, .value = 2.0}}}}, {});
  EXPECT_FALSE(detector.observe(record_at(3.0, Mode::kArmed)));
  EXPECT_FALSE(detector.observe(record_at(4.0)));
  EXPECT_FALSE(detector.observe(record_at(5.9)));
  EXPECT_TRUE(detector.observe(record_at(6.1)));
}

TEST(EventDetector, ASurfaceIsMetWhileItPushesMost) {
  EventDetector detector({{"hit", "", {{.kind = ConditionKind::kSurface, .index = 1}}}}, {});
  CycleRecord record = record_at(0.0);
  for (const int other : {-1, 0}) {
    record.contact.surface = other;
    EXPECT_FALSE(detector.observe(record));
  }
  record.contact.surface = 1;
  EXPECT_TRUE(detector.observe(record));
}

// a level hand axis with this azimuth
Eigen::Matrix3d pointing(double azimuth) {
  return (Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitY()))
      .toRotationMatrix();
}

TEST(EventDetector, AHandleIsThereWithinTenCentimetresAndFifteenDegrees) {
  const auto is_there = [](const Eigen::Vector3d& p, double azimuth) {
    EventDetector detector(
        {{"there", "", {{.kind = ConditionKind::kHandleAt, .place = {1.0, -2.0, M_PI}}}}}, {});
    CycleRecord record = record_at(0.0);
    record.T_B_H = {p, pointing(azimuth)};
    return detector.observe(record).has_value();
  };
  EXPECT_TRUE(is_there({1.0, -2.0, -0.7}, M_PI));  // at any height
  EXPECT_TRUE(is_there({1.06, -2.06, 0.0}, -M_PI + 0.25));
  EXPECT_TRUE(is_there({1.0, -2.0, 0.0}, M_PI - 0.25));
  EXPECT_FALSE(is_there({1.0, -2.0, 0.0}, -M_PI + 0.27));
  EXPECT_FALSE(is_there({1.0, -2.0, 0.0}, M_PI - 0.27));
  EXPECT_FALSE(is_there({1.08, -2.08, 0.0}, M_PI));
}

}  // namespace
}  // namespace hg::analysis

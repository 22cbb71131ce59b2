#include "hg/experiments/contact.h"

#include <gtest/gtest.h>

#include "hg/experiments/player.h"

namespace hg::experiments {
namespace {

config::Scenario shipped_scenario(const std::string& name) {
  return config::load_scenario("models/scenarios/" + name + ".yaml");
}

TEST(Contact, NothingIsFeltInFreeMotion) {
  for (const char* name : {"door", "free_space", "walk"}) {
    config::Scenario free = shipped_scenario(name);
    free.device.compliance.is_on = true;
    Player player(free);
    double largest = 0.0;
    for (bool has_more = true; has_more; has_more = player.end()) {
      player.begin();
      player.run();
      largest = std::max(largest, player.record().touch.share);
    }
    EXPECT_LT(largest, 1.0) << name;
    EXPECT_GT(largest, 0.1) << name;  // it is felt for
  }
}

TEST(Contact, IsReportedInMilliseconds) {
  const config::Scenario walk = shipped_scenario("walk");
  const ContactConfig config;
  for (const HittingPoint& point : config.points) {
    const ContactRun run = hit(walk, config, {"chest", point, 0.25}, true, 1);
    EXPECT_NEAR(run.hit_speed, 0.25, 0.03) << point.name;
    EXPECT_GT(run.force, 10.0) << point.name;
    ASSERT_GE(run.reported, 0.0) << point.name;
    EXPECT_LT(run.reported, 0.02) << point.name;
  }
}

TEST(Contact, ABodyBearsLessWhereTheArmGivesWay) {
  const config::Scenario walk = shipped_scenario("walk");
  const ContactConfig config;
  for (const bool is_clamped : {false, true}) {
    const ContactCase what = {"chest", config.points[0], 0.5, is_clamped};
    const ContactRun stiff = hit(walk, config, what, false, 1);
    const ContactRun yielding = hit(walk, config, what, true, 1);
    EXPECT_LT(yielding.force, stiff.force) << is_clamped;
    EXPECT_LT(yielding.impulse, stiff.impulse) << is_clamped;
    if (is_clamped) {
      EXPECT_LT(yielding.settled_force, 0.5 * stiff.settled_force);
    }
  }
}

}  // namespace
}  // namespace hg::experiments

// Random operation of a remote arm: what counts as a stop, and where ends are felt.

#include "hg/experiments/remote_operation.h"

#include <gtest/gtest.h>

#include "hg/core/error.h"

namespace hg::experiments {
namespace {

config::Scenario arm() { return config::load_scenario("models/arms/ur5e/remote.yaml"); }

TEST(RemoteOperation, StopsNothingAndFeelsEndsWhereTheyAre) {
  RemoteOperationFigures all;
  for (const RemoteOperationFigures& run : operate_at_random(arm(), {}, 1, 2, {})) all.add(run);
  EXPECT_TRUE(is_good(all));
  EXPECT_GT(all.engaged_s, 50.0);
  EXPECT_GT(all.arm_speed, 0.5) << "it has moved";
  EXPECT_GT(all.ends, 0);
  EXPECT_LT(all.arm_beyond, 2e-3);
}

TEST(RemoteOperation, AProtectiveStopIsCountedAndNamed) {
  config::Scenario slow = arm();
  slow.teleoperation->machine.stops.speed = 0.3;
  const auto runs = operate_at_random(slow, {.duration_s = 8.0}, 1, 1, {});
  EXPECT_GT(runs[0].stops, 0);
  EXPECT_FALSE(is_good(runs[0]));
  ASSERT_FALSE(runs[0].notes.empty());
  EXPECT_NE(runs[0].notes[0].find("seed 1: the arm held at"), std::string::npos);
  EXPECT_NE(runs[0].notes[0].find("cause 11"), std::string::npos);
}

TEST(RemoteOperation, NeedsJointsThatAreLed) {
  EXPECT_THROW(
      operate_at_random(config::load_scenario("models/scenarios/remote_arm.yaml"), {}, 1, 1, {}),
      SetupError);
}

}  // namespace
}  // namespace hg::experiments

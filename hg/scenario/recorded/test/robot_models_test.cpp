// Links of device and twin, as other tools draw them.
#include "hg/scenario/recorded/robot_models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "hg/config/simulation/scenario.h"

namespace hg::scenario {
namespace {

TEST(LinkTree, FollowsTheMovingBaseOfTheTwin) {
  const config::Scenario scenario = config::load_scenario("models/scenarios/ship.yaml");
  const messages::LinkTree tree = link_tree(scenario);
  const auto is_root = [](const messages::LinkFrame& frame) {
    return frame.parent == "base" && frame.child.starts_with("twin/");
  };
  const auto root = std::ranges::find_if(tree.frames, is_root) - tree.frames.begin();
  const auto sample = std::make_unique<Sample>();
  RobotState& robot = sample->record.robot;
  robot.q_p.setZero(scenario.device.model.n_p);
  robot.q_m.setZero(scenario.device.model.chain.nq() - scenario.device.model.n_p);
  sample->record.twin.q_a = scenario.twin.model.q_start;
  std::vector<Pose> poses(tree.frames.size());
  for (const double way : {0.0, 0.1, -0.2}) {
    TwinBase& base = sample->operator_input.twin_base;
    base.is_moving = true;
    base.T_B_A = scenario.twin.T_B_root;
    base.T_B_A.p.z() += way;
    tree.poses(*sample, poses);
    EXPECT_LT((poses[root].p - base.T_B_A.p).norm(), 1e-9);
    EXPECT_LT((poses[root].R - base.T_B_A.R).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace hg::scenario

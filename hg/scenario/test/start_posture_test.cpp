#include "hg/scenario/start_posture.h"

#include <gtest/gtest.h>

#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/stacked.h"

namespace hg::scenario {
namespace {

// smallest distance of the shapes in the posture in which the device would start
double distance_at_start(const config::Scenario& scenario) {
  const Start start = find_start(scenario.device, scenario.twin);
  model::ChainData chain(scenario.device.model.chain);
  chain.update_poses(stacked(start.q_p, start.q_m));
  const collision::CollisionConfig& config = scenario.device.collision;
  return collision::Nearest(config.shapes, config.pairs.watched).distance(chain);
}

// A ball stands where the elbow would be: an arm of seven joints can hold its handle elsewise.
TEST(FindStart, AvoidsPosturesInWhichShapesTouch) {
  config::Scenario scenario = config::load_scenario("models/arms/fr3/open_drawer.yaml");
  const Start start = find_start(scenario.device, scenario.twin);
  model::ChainData chain(scenario.device.model.chain);
  chain.update_poses(stacked(start.q_p, start.q_m));
  const int elbow = scenario.device.model.chain.frame("fr3_link4");

  collision::CollisionConfig& config = scenario.device.collision;
  collision::Shape ball = {.name = "ball", .radius = 0.05};
  ball.T_frame_shape.p = chain.pose(elbow).p;
  const collision::Shape link = {.name = "elbow", .body = 4, .frame = elbow, .radius = 0.05};
  config.shapes = {ball, link};
  config.pairs.watched = {{.a = 0, .b = 1, .lever = VectorPM::Ones(7)}};
  ASSERT_LT(collision::Nearest(config.shapes, config.pairs.watched).distance(chain), 0.0);
  EXPECT_GT(distance_at_start(scenario), 0.0);
}

TEST(FindStart, SaysForPeopleWhoChooseWhatIsInTheWay) {
  const config::Scenario door = config::load_scenario("models/scenarios/door.yaml");
  const config::Scenario drawer = config::load_scenario("models/arms/fr3/open_drawer.yaml");
  const auto why = [](const config::DeviceConfig& device, const config::Twin& twin) {
    try {
      find_start(device, twin);
    } catch (const StartError& error) {
      return error.device + ", " + error.twin + ": " + error.why;
    }
    return std::string();
  };
  EXPECT_EQ(why(door.device, drawer.twin), "HapticGiant, drawer: height out of reach");
  EXPECT_EQ(why(drawer.device, door.twin),
            "Franka FR3, door: its nearest posture is 0.50 m and 6 degrees away");
}

}  // namespace
}  // namespace hg::scenario

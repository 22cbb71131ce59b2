#include "hg/check/wall_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hg/check/device_inspection.h"
#include "hg/check/way_force.h"
#include "hg/controller/rendering/motor_torque.h"
#include "hg/workspace/test/cartesian_device.h"

namespace hg::check {
namespace {

// Three prismatic axes of 100, 80 and 120 N before a wrist about the handle; pz carries 5 kg.
config::DeviceConfig boxed_device() {
  config::DeviceConfig device = workspace::cartesian_device();
  for (const double most : {100.0, 80.0, 120.0, 9.0, 8.0, 7.0}) {
    device.model.actuators.push_back(
        {.stiffness = 1e4, .torque_max = most, .speed_full_torque = 1.0, .speed_no_load = 2.0});
  }
  device.model.has_torque_limits = true;
  CartesianLimit hand = {.name = "hand", .frame = device.model.handle};
  hand.axes[0] = {.q_min = -0.5, .q_max = 1.5, .dq_max = 1.0, .ddq_max = 1.0};
  hand.axes[1] = {.q_min = 0.2, .q_max = 1.0, .dq_max = 1.0, .ddq_max = 1.0};
  hand.axes[2] = {.q_min = 0.2, .q_max = 0.8, .dq_max = 1.0, .ddq_max = 1.0};
  device.model.cartesian_limits = {hand};
  return device;
}

TEST(WallForce, OfACartesianDeviceIsWhatItsMotorsHoldBesideTheWeight) {
  const std::vector<WallForce> walls = wall_forces(boxed_device());
  ASSERT_EQ(walls.size(), 6u);
  const double weight = 5.0 * 9.81;
  const std::vector<double> expected = {0.75 * 100.0, 0.75 * 100.0,          0.75 * 80.0,
                                        0.75 * 80.0,  0.75 * 120.0 - weight, 0.75 * 120.0 + weight};
  const std::vector<std::string> motors = {"px", "px", "py", "py", "pz", "pz"};
  for (std::size_t i = 0; i < walls.size(); ++i) {
    EXPECT_EQ(walls[i].axis, static_cast<int>(i) / 2);
    EXPECT_EQ(walls[i].is_upper, i % 2 == 1);
    EXPECT_NEAR(walls[i].least, expected[i], 1e-6) << i;
    EXPECT_NEAR(walls[i].median, expected[i], 1e-6) << i;
    EXPECT_EQ(walls[i].motor, motors[i]);
    EXPECT_EQ(walls[i].places, 49);
  }
  EXPECT_NEAR(walls[1].place.x(), 1.5 - 5e-3, 1e-9);  // where the rendered box has it
}

TEST(WallForce, IsHeldExactlyUpToIt) {
  const auto device = config::load_device("models/arms/fr3/device.yaml");
  const DeviceModel& model = device.model;
  model::ChainData chain(model.chain);
  for (const WallForce& wall : wall_forces(device)) {
    chain.update(wall.q, Eigen::VectorXd::Zero(7));
    EXPECT_NEAR((chain.pose(model.handle).p - wall.place).norm(), 0.0, 1e-3);
    Vector6 w = Vector6::Zero();
    w[wall.axis] = (wall.is_upper ? 1.0 : -1.0) * wall.least;
    const Eigen::VectorXd tau =
        chain.gravity() - chain.jacobian(model.handle).transpose() * Eigen::VectorXd(w);
    double most = 0.0;
    int motor = 0;
    for (int i = 0; i < 7; ++i) {
      const double share = std::abs(tau[i]) / rendering::allowed_torque(model.actuators[i], 0.0).ub;
      if (share > most) motor = i;
      most = std::max(most, share);
    }
    EXPECT_NEAR(most, 1.0, 1e-9);
    EXPECT_EQ(model.manipulator_joint(motor), wall.motor);
    EXPECT_GE(wall.median, wall.least);
  }
}

// Simulated hands that pressed ever harder: 26 N held below the box and 29 N did not.
TEST(WallForce, OfASevenJointArmCountsItsMotionInItself) {
  const std::vector<WallForce> walls =
      wall_forces(config::load_device("models/arms/fr3/device.yaml"));
  ASSERT_EQ(walls.size(), 6u);
  EXPECT_GT(walls[4].least, 15.0);
  EXPECT_LT(walls[4].least, 29.0);
  EXPECT_EQ(walls[4].motor, "fr3_joint2");
}

TEST(WallForce, IsNotStatedWithoutMotorsOrWalls) {
  config::DeviceConfig device = boxed_device();
  device.model.cartesian_limits.clear();
  EXPECT_TRUE(wall_forces(device).empty());
  device = boxed_device();
  device.model.has_torque_limits = false;
  EXPECT_TRUE(wall_forces(device).empty());
}

TEST(WallForce, OfAWallThatIsReachedOnlyByATiltedHandleIsStatedWithTheTilt) {
  for (const WallForce& wall : wall_forces(config::load_device("models/arms/gen3/device.yaml"))) {
    const bool is_tilted = wall.axis == 2 && wall.is_upper;
    EXPECT_EQ(wall.tilt, is_tilted ? 0.4 : 0.0);
    EXPECT_GT(wall.places, 0);
  }
}

TEST(WallForce, OfAHapticGiantIsThatOfItsClosedForm) {
  for (const WallForce& wall :
       wall_forces(config::load_device("models/haptic_giant/device.yaml"))) {
    if (wall.axis == 2) continue;
    EXPECT_GT(wall.places, 10);
    EXPECT_NEAR(wall.least, 154.0, 5.0);
  }
}

TEST(WallForce, BelowFiftyNewtonsIsAWarning) {
  config::DeviceConfig device = boxed_device();
  Collector out(device.sources, device.places);
  inspect_wall_forces(device, out);
  ASSERT_EQ(out.findings.size(), 6u);
  EXPECT_EQ(out.findings[0].severity, Severity::kNote);
  EXPECT_EQ(out.findings[0].item, "cartesian_limits[0].x");
  EXPECT_NE(out.findings[0].what.find("hand x- holds 75 N (px, at x -0.49"), std::string::npos)
      << out.findings[0].what;
  EXPECT_EQ(out.findings[4].severity, Severity::kWarning);
  EXPECT_NE(out.findings[4].what.find("hand z- holds 41 N (pz"), std::string::npos);
  EXPECT_NE(out.findings[4].what.find("rule 324"), std::string::npos);

  const Findings all = inspect(device, workspace::survey(device, {.postures = 500}));
  EXPECT_EQ(std::ranges::count_if(all,
                                  [](const Finding& finding) {
                                    return finding.what.find(" holds ") != std::string::npos;
                                  }),
            6);
}

// A drawer that opens along x, led from one place to another.
TEST(WayForce, OfADrawerIsWhatTheMotorsAlongItHoldAndInAnyDirectionTheWeakest) {
  const config::DeviceConfig device = boxed_device();
  const config::Twin twin = config::load_twin("models/arms/fr3/drawer.yaml");
  workspace::Way way = {.led = {0}, .places = {}};
  for (const double at : {0.1, 0.3}) {
    way.places.push_back(
        {Eigen::VectorXd{{0.5 + at, 0.4, 0.5, 0.0, 1.5, 0.0}}, ConfigurationA::Constant(1, at)});
  }
  const WayForces forces = way_forces(device, twin, way);
  ASSERT_EQ(forces.joints.size(), 1u);
  EXPECT_NEAR(forces.joints[0].force, 0.75 * 100.0, 1e-6);
  EXPECT_EQ(forces.joints[0].motor, "px");
  EXPECT_EQ(forces.joints[0].at, 0.1);
  EXPECT_NEAR(forces.any.force, 0.75 * 120.0 - 5.0 * 9.81, 1e-6);
  EXPECT_EQ(forces.any.motor, "pz");

  Collector out(twin.sources, twin.places);
  inspect_way_forces(device, twin, way, out);
  ASSERT_EQ(out.findings.size(), 2u);
  EXPECT_EQ(out.findings[0].severity, Severity::kNote);
  EXPECT_EQ(out.findings[1].severity, Severity::kWarning);
  EXPECT_NE(out.findings[1].what.find("of 41 N in any direction (pz)"), std::string::npos);

  way.led.clear();
  EXPECT_TRUE(way_forces(device, twin, way).joints.empty());
}

TEST(WayForce, IsLookedAtUpToTheEndsOfTheWay) {
  const auto scenario = config::load_scenario("models/arms/fr3/open_drawer.yaml");
  const workspace::Way way = workspace::lead(scenario.device, scenario.twin);
  double lowest = 1.0, highest = 0.0;
  for (const workspace::Place& place : way.places) {
    lowest = std::min(lowest, place.q_a[0]);
    highest = std::max(highest, place.q_a[0]);
  }
  EXPECT_NEAR(lowest, 0.0, 1e-3);
  EXPECT_NEAR(highest, 0.3, 1e-3);
  EXPECT_LT(way.places.size(), 100u);
}

}  // namespace
}  // namespace hg::check

#include "hg/check/drive_loop.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "hg/check/stiffness.h"
#include "hg/config/simulation/scenario.h"
#include "hg/scenario/start_posture.h"

namespace hg::check {
namespace {

config::Scenario tool(const std::string& arm) {
  return config::load_scenario("models/arms/" + arm + "/move_tool.yaml");
}

VectorPM start_of(const config::Scenario& scenario) {
  const scenario::Start start = scenario::find_start(scenario.device, scenario.twin);
  return stacked(start.q_p, start.q_m);
}

TEST(DriveLoop, DelayIsThatOfSensorPeriodAndWayToTheDrives) {
  config::Scenario scenario = tool("ur5e");
  const double delay = drive_delay(scenario.device);
  EXPECT_NEAR(delay, 0.008 + 0.001 + 0.002, 1e-12);  // way, half of 2 ms, sensor
  EXPECT_EQ(stiffness_limits(scenario.device, scenario.twin).delay, delay);
  scenario.device.simulation.drives.latency += 0.003;
  EXPECT_NEAR(drive_delay(scenario.device), delay + 0.003, 1e-12);
}

// Drives that are too fast and joints too stiff to be felt leave the hand, late by T: the border of
// m s^2 + b s + K + (k + c s) exp(-s T) with a hand that is held at the other end of its grip.
TEST(DriveLoop, OfRigidDrivesIsTheHandLateByTheDelay) {
  config::Scenario scenario = tool("ur5e");
  config::SimulatedDeviceConfig& device = scenario.device;
  device.simulation.drives.loop = {.position_Hz = 1e5, .speed_Hz = 1e5};
  device.simulation.drives.current_lag = 0.0;
  device.estimation.wrench.has_imu = true;  // nothing beyond the sensor
  for (ActuatorModel& motor : device.model.actuators) motor.stiffness = 1e9;
  const FeelingHand held = {.stiffness = 1e9, .grip_stiffness = 500.0, .grip_damping = 5.0};
  const DriveLoop loop(device, start_of(scenario), Eigen::Matrix3d::Identity(), held);
  const double T = drive_delay(device), b = 4.0, k = 500.0, c = 5.0, m = 3.0;
  double expected = kInfinity;
  for (double w = 2.0 * M_PI * 0.5; w < 2.0 * M_PI * 60.0; w += 0.01) {
    const std::complex<double> response =
        std::complex<double>(k, c * w) * std::exp(std::complex<double>(0.0, -w * T));
    if (b + response.imag() / w < 0.0) {
      expected = std::min(expected, m * w * w - response.real());
    }
  }
  ASSERT_TRUE(std::isfinite(expected));
  ASSERT_GT(expected, 0.0);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(loop.stiffest_wall(axis, m, b), expected, 0.05 * expected) << axis;
  }
}

// Simulated hands against a wall across y with 4 Ns/m beside the twin's: the stiffest that was calm
// had 2.5 kN/m with 1 kg, 34 kN/m with 3 kg, and more than 50 kN/m with 6 kg.
TEST(DriveLoop, FitsTheWallsThatWereCalm) {
  const config::Scenario scenario = tool("ur5e");
  const DriveLoop loop(scenario.device, start_of(scenario));
  EXPECT_NEAR(loop.stiffest_wall(1, 1.0, 8.0), 2.5e3, 0.3 * 2.5e3);
  EXPECT_NEAR(loop.stiffest_wall(1, 3.0, 8.0), 34e3, 0.2 * 34e3);
  EXPECT_GT(loop.stiffest_wall(1, 6.0, 8.0), 50e3);
}

TEST(DriveLoop, LightestTwinIsTheOneWithoutRoomForAWall) {
  const config::Scenario scenario = tool("ur5e");
  const DriveLoop loop(scenario.device, start_of(scenario));
  for (int axis = 0; axis < 3; ++axis) {
    const double lightest = loop.lightest_mass(axis, 4.0);
    EXPECT_GT(lightest, 0.3);
    EXPECT_EQ(loop.stiffest_wall(axis, 0.99 * lightest, 4.0), 0.0);
    EXPECT_GT(loop.stiffest_wall(axis, 1.01 * lightest, 4.0), 0.0);
  }
}

TEST(DriveLoop, GivesTheLimitsOfDevicesWhoseDrivesFollowPositions) {
  const config::Scenario scenario = tool("ur5e");
  const StiffnessLimits limits = stiffness_limits(scenario.device, scenario.twin);
  ASSERT_TRUE(limits.calm);
  EXPECT_EQ(limits.by_frequency(), std::ranges::min(limits.calm->stiffness));
  Collector out(scenario.twin.sources, scenario.twin.places);
  inspect_stiffness(scenario.device, scenario.twin, {}, out);
  ASSERT_FALSE(out.findings.empty());
  EXPECT_NE(out.findings[0].what.find("T_d = 11.0 ms"), std::string::npos);
  EXPECT_NE(out.findings[0].what.find("without a surface it shakes below x "), std::string::npos)
      << out.findings[0].what;

  // 3 kg against a wall across y and z, with 4 Ns/m: 36 to 38 and 18 to 19 kN/m were calm
  surfaces::Surface wall = {.name = "wall", .shape = surfaces::Plane{}, .damping = 4.0};
  const auto stiffest = [&](double mass_share, const Eigen::Vector3d& normal) {
    config::Scenario light = scenario;
    light.twin.model.mass_scale *= mass_share;
    wall.pose.R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    const StiffnessLimits found = stiffness_limits(light.device, light.twin, {&wall, 1});
    EXPECT_EQ(found.by_frequency(0), found.by_frequency());
    return found.by_frequency();
  };
  const double three_kg = 3.0 / limits.mass;
  EXPECT_NEAR(stiffest(three_kg, Eigen::Vector3d::UnitY()), 37e3, 0.2 * 37e3);
  EXPECT_NEAR(stiffest(three_kg, Eigen::Vector3d::UnitZ()), 18e3, 0.2 * 18e3);
  EXPECT_EQ(stiffest(0.2 * three_kg, Eigen::Vector3d::UnitY()), 0.0);  // shakes in the hand alone
  EXPECT_EQ(stiffest(10.0 * three_kg, Eigen::Vector3d::UnitY()), surfaces::kStiffness.ub);
  wall.contact = surfaces::Contact::kStop;
  EXPECT_EQ(stiffest(three_kg, Eigen::Vector3d::UnitY()), kInfinity);

  const config::Scenario torques = tool("fr3");
  EXPECT_FALSE(stiffness_limits(torques.device, torques.twin).calm);
}

}  // namespace
}  // namespace hg::check

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

  const config::Scenario torques = tool("fr3");
  EXPECT_FALSE(stiffness_limits(torques.device, torques.twin).calm);
}

// Simulated hands: 36 to 38 kN/m were calm across y, 18 to 19 across z with 3 kg, 48 to 51 across y
// with 6 kg, and nothing with 1 kg.
TEST(DriveLoop, GivesTheLimitOfEachSurfaceAcrossItAndWithItsDamping) {
  config::Scenario scenario = tool("ur5e");
  const double axes = stiffness_limits(scenario.device, scenario.twin).by_frequency();
  const double file = stiffness_limits(scenario.device, scenario.twin).mass;
  surfaces::Surface wall = {.name = "wall", .shape = surfaces::Plane{}, .damping = 4.0};
  const auto stiffest = [&](double mass, const Eigen::Vector3d& normal) {
    config::Scenario with_mass = scenario;
    with_mass.twin.model.mass_scale *= mass / file;
    wall.pose.R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    return stiffness_limits(with_mass.device, with_mass.twin, {&wall, 1}).by_frequency(0);
  };
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(stiffest(3.0, y), 37e3, 0.2 * 37e3);
  EXPECT_NEAR(stiffest(3.0, z), 18e3, 0.2 * 18e3);
  EXPECT_GT(stiffest(6.0, y), 50e3);
  EXPECT_EQ(stiffest(1.0, y), 0.0);
  const double damped = (wall.damping = 40.0, stiffest(3.0, z));
  EXPECT_GT(damped, 1.3 * 18e3);
  wall.contact = surfaces::Contact::kStop;
  EXPECT_EQ(stiffest(3.0, y), kInfinity);

  // what is said of springs stays that of the twin alone, and of stops nothing
  const StiffnessLimits limits = stiffness_limits(scenario.device, scenario.twin, {&wall, 1});
  EXPECT_EQ(limits.by_frequency(), axes);
  Collector out(scenario.twin.sources, scenario.twin.places);
  inspect_stiffness(scenario.device, scenario.twin, {&wall, 1}, out);
  EXPECT_EQ(out.findings.at(0).what.find("of the scenario"), std::string::npos);
  wall.contact = surfaces::Contact::kSpring;
  inspect_stiffness(scenario.device, scenario.twin, {&wall, 1}, out);
  EXPECT_NE(out.findings.back().what.find("on the surfaces of the scenario"), std::string::npos);
}

}  // namespace
}  // namespace hg::check

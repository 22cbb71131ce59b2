#include "hg/scenario/assembly.h"

#include <gtest/gtest.h>

#include <string>

#include "hg/core/test/message_of.h"
#include "hg/scenario/names.h"

namespace hg::scenario {
namespace {

config::Scenario door() { return config::load_scenario("models/scenarios/door.yaml"); }

// leaves q4+q5 a window of `width` rad: 1 mrad holds about one random posture of 5000
config::Scenario door_with_window(double width) {
  config::Scenario scenario = door();
  limits::JointLimits& sum = scenario.device.model.virtual_joints.front().limits;
  sum.q_min = 1.5;
  sum.q_max = 1.5 + width;
  return scenario;
}

std::string message(const config::Scenario& scenario) {
  return message_of([&] { make_cycle(scenario); });
}

TEST(MakeCycle, ANarrowVirtualLimitDoesNotHideAnUnstableLoop) {
  EXPECT_EQ(message(door_with_window(1e-3)), "no error");
  config::Scenario unstable = door_with_window(1e-3);
  unstable.device.estimation.link_pole_Hz = 10.0;  // [C] 2
  EXPECT_NE(message(unstable).find("the torque loop is stable up to 0 s"), std::string::npos)
      << message(unstable);
}

TEST(MakeCycle, VirtualLimitsThatNoPostureKeepsAreRefused) {
  EXPECT_EQ(
      message(door_with_window(-1.0)),
      "virtual_joints: only 0 of 1000000 random postures within the limits of the joints keep "
      "these limits, 32 are needed to check that the torque loop is stable: widen them, or "
      "tighten those of the joints");
}

TEST(MakeCycle, TheRateMustSuitTheFilterOfTheFeedforward) {
  config::Scenario scenario = door();
  EXPECT_EQ(message_of([&] { config::check_rate(scenario.device, 200.0); }),
            "control.flatness_Hz: at 200 Hz it must be below 39.3, or the torques fed forward "
            "oscillate, got 95: lower it, or raise the rate");
  EXPECT_EQ(scenario.device.model.rate_Hz, 1000.0);
  scenario.device.control.flatness_Hz = 200.0;
  EXPECT_NE(message(scenario).find("it must be below 196.7"), std::string::npos);
}

TEST(Idealisation, NamesWhatASimulationLeavesOut) {
  config::SimulatedDeviceConfig device = door().device;
  EXPECT_EQ(idealisation(device), "");
  device.simulation.sensors = simulator::ideal_sensors();
  EXPECT_EQ(idealisation(device), "ideal encoders, ideal force/torque sensor");
  const auto arm = config::load_simulated_device("models/examples/arm.yaml");
  EXPECT_EQ(idealisation(arm), "ideal drives, ideal encoders, ideal force/torque sensor");
}

}  // namespace
}  // namespace hg::scenario

#include "hg/start_test/device_station.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "hg/scenario/assembly.h"

namespace hg::start_test {
namespace {

struct Bench {
  config::Scenario scenario = config::load_scenario("models/scenarios/free_space.yaml");
  std::atomic<bool> interrupted{false};
  std::vector<std::string> printed;

  DeviceStation station() {
    return {scenario, scenario::make_simulated_device(scenario), true, interrupted,
            [this](double, const std::string& words) { printed.push_back(words); }};
  }
};

TEST(DeviceStation, FaultsOfTheComputerActInAStartTest) {
  Bench bench;
  bench.scenario.faults = {{.kind = faults::find_kind("cycles_late"), .magnitude = 1e6}};
  DeviceStation station = bench.station();
  FaultCode fault = FaultCode::kNone;  // once the drives are on
  for (int k = 0; k < 5000 && fault == FaultCode::kNone; ++k) {
    fault = station.advance(Wish::kArm).fault;
  }
  EXPECT_EQ(fault, FaultCode::kCycleOverrun);
}

TEST(DeviceStation, AnInterruptionEndsIt) {
  Bench bench;
  DeviceStation station = bench.station();
  EXPECT_NO_THROW(station.advance(Wish::kTare));
  bench.interrupted = true;
  EXPECT_THROW(station.advance(Wish::kTare), Ended);
  EXPECT_EQ(station.end(), FaultCode::kNone);
  station.prompt(Act::kLean, "lean on the handle");
  EXPECT_EQ(bench.printed, std::vector<std::string>{"-> lean on the handle"});
}

TEST(SetupOf, ABrakeHasToHoldTwiceTheFrictionOfItsJoint) {
  const Bench bench;
  const config::DeviceConfig& device = bench.scenario.device;
  const auto setup = setup_of(device, true);
  ASSERT_EQ(setup.gantry.size(), 2U);
  ASSERT_EQ(setup.manipulator.size(), 6U);
  EXPECT_TRUE(setup.gantry[0].is_slide);
  EXPECT_EQ(setup.gantry[0].least_load, 20.0);  // N
  const ActuatorModel& actuator = device.model.actuators[2];
  EXPECT_EQ(setup.manipulator[2].least_load, 2.0 * actuator.stiction * actuator.coulomb_friction);
}

}  // namespace
}  // namespace hg::start_test

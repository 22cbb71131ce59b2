#include "hg/workspace/way.h"

#include <gtest/gtest.h>

#include <string>

#include "hg/core/open_file.h"

namespace hg::workspace {
namespace {

constexpr double kNear = -0.48, kFar = 0.8;

config::SimulatedDeviceConfig arm() {
  return config::load_simulated_device("models/examples/arm.yaml");
}

config::SimulatedDeviceConfig giant() {
  return config::load_simulated_device("models/haptic_giant/device.yaml");
}

// The example's gate, held by the example's arm, with the hinge at y; 0.45 m from hinge to handle.
config::Twin gate(double y, const std::string& keys = "") {
  config::SourceReader reader(
      {{"twin.yaml",
        "name: gate\nurdf: gate.urdf\nend_effector: handle\n"
        "placement: {x_m: 0.05, y_m: " +
            std::to_string(y) +
            ", z_m: 0.78}\n"
            "joints: {hinge: {ddq_max_rad_per_s2: 4, damping_Nms_per_rad: 90" +
            keys + "}}\n"},
       {"gate.urdf", read_file("models/examples/gate.urdf", 1'000'000)}});
  return config::load_twin("twin.yaml", reader);
}

TEST(Way, ATwinWithinReachIsLedThroughAllOfIt) {
  const Way way = lead(arm(), gate(kNear));
  EXPECT_GE(way.share, kWholeWay);
  EXPECT_EQ(problem_of(way), "");
}

TEST(Way, WhatIsInTheWayIsNamed) {
  // the hand gets to the end of the arm's reach
  const Way way = lead(arm(), gate(kFar));
  EXPECT_LT(way.share, kWholeWay);
  EXPECT_EQ(way.twin_joint, "hinge");
  EXPECT_NE(problem_of(way), "");
}

TEST(Way, IsTheSameInEveryTrial) {
  const Way first = lead(arm(), gate(kFar)), second = lead(arm(), gate(kFar));
  EXPECT_EQ(first.share, second.share);
  EXPECT_EQ(first.at_limit_s, second.at_limit_s);
}

TEST(Way, ForcesOfTheTwinAreNoMatterOfTheDevice) {
  const std::string heavy =
      ", stiffness_Nm_per_rad: 200, friction_Nm: 300, preload_Nm: 100, "
      "quadratic_damping_Nms2_per_rad2: 50";
  EXPECT_EQ(problem_of(lead(arm(), gate(kNear, heavy))), "");
}

TEST(Way, LocksAreOpen) {
  // the door is locked until its lever is down
  EXPECT_EQ(problem_of(lead(giant(), config::load_twin("models/twins/door/twin.yaml"))), "");
}

TEST(Way, ATwinThatFloatsOrHasMoreJointsThanAScriptMovesIsNotLed) {
  for (const char* name : {"free_space", "chain_20"}) {
    const config::Twin twin = config::load_twin(std::string("models/twins/") + name + "/twin.yaml");
    EXPECT_EQ(problem_of(lead(giant(), twin)), "") << name;
  }
}

TEST(Way, AJointWithoutLimitsHasNoRangeToBeLedThrough) {
  config::Twin twin = gate(kFar);
  twin.model.dofs[0].limits.q_max = kInfinity;
  EXPECT_EQ(lead(arm(), twin).share, 1.0);
}

TEST(Way, ProblemSaysHowFarAndWhatIsInTheWay) {
  EXPECT_EQ(problem_of({}), "");
  EXPECT_EQ(
      problem_of({.share = 0.62,
                  .twin_joint = "hinge",
                  .at_limit_s = 3.21,
                  .limit = "m4",
                  .excess = 0.0031,
                  .exceeded = "m5"}),
      "led through its whole range by a hand: hinge comes through 62 % of its range; m4 of the "
      "device stands at its limit for 3.2 s; m5 of the device leaves its limit by 3.1 mm or "
      "mrad");
  EXPECT_EQ(problem_of({.fault = "tracking lost"}),
            "led through its whole range by a hand: the trial ends in a fault, tracking lost");
  EXPECT_EQ(problem_of({.rushed_s = 0.31, .rushed = "m3"}),
            "led through its whole range by a hand: m3 of the device moves at its largest speed "
            "for 0.3 s");
  EXPECT_EQ(problem_of({.shaken_s = 0.44}),
            "led through its whole range by a hand: hand and device oscillate against each other "
            "for 0.4 s");
}

}  // namespace
}  // namespace hg::workspace

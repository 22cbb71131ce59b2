// Injected faults of a scenario.

#include <gtest/gtest.h>

#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/core/error.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

Scenario load_faults(const std::string& faults) {
  SourceReader shipped;
  std::vector<SourceText> texts = {
      {"models/scenarios/run.yaml",
       "title: a\ndescription: b\ndevice: ../haptic_giant/device.yaml\n"
       "twin: ../twins/door/twin.yaml\nperson: mouse\nduration_s: 3\nfaults:\n" +
           faults}};
  for (const SourceText& source : load_scenario("models/scenarios/door.yaml").sources) {
    if (source.name != "models/scenarios/door.yaml") texts.push_back(source);
  }
  return load_scenario(texts);
}

TEST(ScenarioFaults, EveryKindThatHasPartsTakesTheNameOfOne) {
  for (const faults::Kind& kind : faults::kinds()) {
    int taken = faults::parts_of(kind.part, 6, 2) == 0 ? 1 : 0;
    for (const char* part : {"m1", "ppu1", "x", "stop buttons"}) {
      if (taken > 0) break;
      try {
        load_faults("  - {at_s: 1, fault: " + std::string(kind.name) + ", of: " + part +
                    (kind.unit.empty() ? "}\n" : ", magnitude: 1}\n"));
        ++taken;
      } catch (const SetupError&) {
        continue;  // it is one of the others
      }
    }
    EXPECT_EQ(taken, 1) << kind.name;
  }
}

std::string message(const std::string& fault) {
  return message_of([&] { load_faults("  - " + fault + "\n"); });
}

TEST(ScenarioFaults, NameJointsAxesAndComponents) {
  const auto faults = load_faults(
                          "  - {at_s: 1, fault: link_encoder_jump, of: m3, magnitude: -0.2}\n"
                          "  - {at_s: 2, for_s: 0.5, fault: gantry_dead, of: ppu2}\n"
                          "  - {at_s: 3, fault: force_sensor_offset, of: torque y, magnitude: 2}\n"
                          "  - {at_s: 4, fault: drive_fault}\n"
                          "  - {at_s: 5, fault: brake_weak, of: m6}\n"
                          "  - {at_s: 6, fault: safety_channel_opens, of: dead-man switch}\n")
                          .faults;
  ASSERT_EQ(faults.size(), 6U);
  EXPECT_EQ(faults[0].kind->name, "link_encoder_jump");
  EXPECT_EQ(faults[0].index, 2);
  EXPECT_EQ(faults[0].magnitude, -0.2);
  EXPECT_EQ(faults[0].from_s, 1.0);
  EXPECT_EQ(faults[0].for_s, 0.0);
  EXPECT_EQ(faults[1].index, 1);
  EXPECT_EQ(faults[1].for_s, 0.5);
  EXPECT_EQ(faults[2].index, 4);
  EXPECT_EQ(faults[3].index, 0);
  EXPECT_EQ(faults[4].index, 5);
  EXPECT_EQ(faults[5].index, 2);
}

TEST(ScenarioFaults, AreRefusedWithTheirPlace) {
  const std::string at = "models/scenarios/run.yaml:8:";
  EXPECT_EQ(message("{at_s: 1, fault: drive_fautl}"),
            at + "22: faults[0].fault: must be a fault, got 'drive_fautl', did you mean "
                 "'drive_fault'?");
  EXPECT_EQ(message("{at_s: 1, fault: gantry_dead}"),
            at + "5: faults[0]: this fault needs one of its joints, components or inputs");
  EXPECT_EQ(message("{at_s: 1, fault: gantry_dead, of: m1}"),
            at + "39: faults[0].of: this fault needs one of its joints, components or inputs");
  EXPECT_EQ(message("{at_s: 1, fault: gantry_dead, of: x}"),
            at + "39: faults[0].of: this fault needs one of its joints, components or inputs");
  EXPECT_EQ(message("{at_s: 1, fault: drive_fault, of: m1}"),
            at + "39: faults[0].of: this fault concerns no single joint, component or input");
  EXPECT_EQ(message("{at_s: 1, fault: motor_hot, of: m1}"),
            at + "5: faults[0]: this fault needs a magnitude");
  EXPECT_EQ(message("{at_s: 1, fault: bus_errors, magnitude: -1}"),
            at + "45: faults[0].magnitude: must not be negative for this fault");
  EXPECT_EQ(message("{at_s: 1, fault: commands_late, magnitude: 17}"),
            at + "48: faults[0].magnitude: must be at most 16 periods");
  EXPECT_EQ(
      message("{at_s: 1, fault: solver_hurried, magnitude: 0.5}"),
      at + "49: faults[0].magnitude: must be a whole number of active sets from 1 to 1000000");
  EXPECT_EQ(message("{at_s: 1, fault: drive_fault, magnitude: 2}"),
            at + "46: faults[0].magnitude: this fault has no magnitude");
}

}  // namespace
}  // namespace hg::config

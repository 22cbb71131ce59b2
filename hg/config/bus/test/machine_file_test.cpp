#include "hg/config/bus/machine_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

using ethercat::DriveMode;
using ethercat::Input;
using ethercat::Output;

const std::vector<std::string> kJoints = {"x", "m1"};

std::string drive(
    const std::string& name, const std::string& joint, const std::string& mode,
    const std::string& outputs = "{object: 0x6071, bits: 16, is: target_torque, scale: 0.1}") {
  return "  - name: " + name + "\n    vendor: 0xFFFFFFFF\n    product: 0x10\n    revision: 3\n" +
         "    joint: " + joint + "\n    mode: " + mode + "\n" +
         "    outputs: [{object: 0x6040, bits: 16, is: control_word}, " + outputs +
         ", {object: 0x6060, bits: 8, is: mode}]\n" +
         "    inputs: [{object: 0x6041, bits: 16, is: status_word}, {object: 0x60E4, subindex: 1, "
         "bits: 32, is: link_position, scale: -1e-6, offset: 0.5}]\n";
}

const std::string kAxis =
    drive("axis", "x", "csv", "{object: 0x60FF, bits: 32, is: target_velocity, scale: 1e-6}");

const std::string kPanel =
    "  - {name: panel, vendor: 1, product: 1, revision: 1, inputs: [{object: 0x6000, bits: 1, is: "
    "emergency_stop, inverted: true}, {object: 0x6001, bits: 1, is: dead_man}, {bits: 6}]}\n";

ethercat::Machine load(const std::string& slaves, const std::vector<std::string>& joints,
                       const std::string& head = "name: bench\nbrake_closing_s: 0.03\n") {
  SourceReader reader({{"machine.yaml", head + "slaves:\n" + slaves}});
  return load_machine("machine.yaml", reader, joints);
}

std::string fault_of(const std::string& slaves, const std::string& head =
                                                    "name: bench\n"
                                                    "brake_closing_s: 0.03\n") {
  return message_of([&] { load(slaves, kJoints, head); });
}

TEST(MachineFile, HasSlavesInTheOrderOfTheCable) {
  const ethercat::Machine machine = load(kAxis + drive("one", "m1", "cst") + kPanel, kJoints);
  ASSERT_EQ(machine.slaves.size(), 3u);
  const ethercat::Slave& slave = machine.slaves[1];
  EXPECT_EQ(slave.name, "one");
  EXPECT_EQ(slave.vendor, 0xFFFFFFFFu);
  EXPECT_EQ(slave.product, 16u);
  EXPECT_EQ(slave.joint, 1);
  EXPECT_EQ(slave.mode, DriveMode::kCst);
  ASSERT_EQ(slave.outputs.size(), 3u);
  EXPECT_EQ(slave.outputs[1].meaning, Output::kTargetTorque);
  EXPECT_EQ(slave.inputs[1].meaning, Input::kLinkPosition);
  EXPECT_EQ(slave.inputs[1].object, 0x60E4u);
  EXPECT_EQ(slave.inputs[1].subindex, 1u);
  EXPECT_EQ(slave.inputs[1].scale, -1e-6);
  EXPECT_EQ(slave.inputs[1].offset, 0.5);
  EXPECT_EQ(bits_of(slave.inputs), 48u);
}

TEST(MachineFile, OfAnyDeviceTakesAnyJoint) {
  const ethercat::Machine machine = load(drive("one", "elbow", "cst") + kPanel, {});
  EXPECT_EQ(machine.slaves[0].mode, DriveMode::kCst);
  EXPECT_EQ(machine.slaves[0].joint, -1);
}

TEST(MachineFile, ShippedOneFitsTheHapticGiant) {
  SourceReader reader;
  const ethercat::Machine machine =
      load_machine("models/haptic_giant/machine.yaml", reader,
                   {"ppu1", "ppu2", "m1", "m2", "m3", "m4", "m5", "m6"});
  EXPECT_EQ(machine.slaves.size(), 11u);
}

TEST(MachineFile, NamesWhatIsWrongAndWhere) {
  const auto expect = [](const std::string& slaves, const std::string& words) {
    const std::string fault = fault_of(slaves);
    EXPECT_NE(fault.find(words), std::string::npos) << fault;
  };
  expect(kAxis + drive("one", "m2", "cst"),
         "machine.yaml:16:12: slaves[1].joint: must be a joint of the device, got 'm2', did you "
         "mean 'm1'?");
  expect(kAxis, "joint 'm1' must have one drive, got 0");
  expect(kAxis + drive("one", "m1", "cst") + drive("two", "m1", "cst"),
         "joint 'm1' must have one drive, got 2");
  expect(kAxis + drive("axis", "m1", "cst"), "two slaves have the same name");
  expect(kAxis + drive("one", "m1", "csp"), "the target of its mode is missing");
  expect(
      kAxis + drive("one", "m1", "cst", "{object: 0x6071, bits: 15, is: target_torque, scale: 1}"),
      "must be whole bytes");
  expect(
      kAxis + drive("one", "m1", "cst", "{object: 0x6071, bits: 32, is: target_torque, scale: 1}"),
      "slaves[1].outputs: object 0x6071 has 16 bits by CiA 402, got 32");
  expect(kAxis + drive("one", "m1", "cst", "{bits: 16, is: target_torque, scale: 1}"),
         "a gap (object 0) has no meaning");
  expect(kAxis + drive("one", "m1", "cst", "{object: 0x16071, bits: 16, is: target_torque}"),
         "object: must be a whole number from 0 to 65535, also as 0x1A, got '0x16071'");
  expect(kAxis + drive("one", "m1", "cst", "{object: 6.5, bits: 16, is: target_torque}"),
         "got '6.5'");
  expect(kAxis + drive("one", "m1", "cst", "{object: 0x6071, bits: 16, is: target_toque}"),
         "did you mean 'target_torque'?");
}

TEST(MachineFile, DemandsWhatAMachineWithPowerNeeds) {
  const auto expect = [](const std::string& fault, const std::string& words) {
    EXPECT_NE(fault.find(words), std::string::npos) << fault;
  };
  const std::string slaves = kAxis + drive("one", "m1", "cst") + kPanel;
  const auto with = [&](const std::string& head) {
    return fault_of(slaves, "name: bench\n" + head);
  };
  EXPECT_EQ(with("brake_closing_s: 0\n"), "no error");
  EXPECT_EQ(with("brake_closing_s: 0.2\nwatchdog_s: 0.1\n"), "no error");
  expect(with(""), "key 'brake_closing_s' is missing: how long brakes take to close");
  expect(
      with("brake_closing_s: 0\nwatchdog_s: 0.2\n"),
      "machine.yaml:3:13: watchdog_s: must be at most 0.1 s: for so long drives go on with their "
      "last commands when this computer has stopped, got 0.2");
  expect(fault_of(kAxis + drive("one", "m1", "cst")),
         "no slave has the input 'emergency_stop': a machine with drives needs one");
  expect(with("moves_with_frames: true\n"),
         "machine.yaml:2:20: moves_with_frames: slave 'axis' is no simulated one (vendors "
         "0x00ffff00 to 0x00ffffff): a machine keeps its own time, and needs its start test");
  EXPECT_EQ(load("  - {name: io, vendor: 1, product: 1, revision: 1}\n", {}, "name: bench\n")
                .slaves.size(),
            1u);  // no drives, no power
}

TEST(MachineFile, OfASimulationMayTakeItsTime) {
  const std::string panel = "  - {name: io, vendor: 0x00FFFF01, product: 1, revision: 1}\n";
  const ethercat::Machine machine =
      load(panel, {}, "name: bench\nmoves_with_frames: true\nwatchdog_s: 2\n");
  EXPECT_EQ(machine.watchdog_s, 2.0);
}

TEST(MachineFile, EachMeasureNeedsItsScale) {
  const auto expect = [](const std::string& outputs, const std::string& words) {
    const std::string fault = fault_of(kAxis + drive("one", "m1", "cst", outputs) + kPanel);
    EXPECT_NE(fault.find(words), std::string::npos) << fault;
  };
  expect(
      "{object: 0x6071, bits: 16, is: target_torque}",
      "machine.yaml:18:92: slaves[1].outputs[1].is: needs a scale: how many SI units a count is");
  std::string slaves = kAxis + drive("one", "m1", "cst") + kPanel;
  slaves.replace(slaves.rfind(", scale: -1e-6"), 14, "");
  EXPECT_NE(fault_of(slaves).find("slaves[1].inputs[1].is: needs a scale"), std::string::npos)
      << fault_of(slaves);
}

TEST(MachineFile, TwoSlavesCannotBeTheSameButton) {
  std::string other = kPanel;
  other.replace(other.find("panel"), 5, "other");
  const std::string fault = fault_of(kAxis + drive("one", "m1", "cst") + kPanel + other);
  for (const char* const words :
       {"slaves[3].inputs[0].is: slave 'panel' gives this already in line 20, only one can count",
        "machine.yaml:21:", "slaves[3].inputs[1].is: slave 'panel'"}) {
    EXPECT_NE(fault.find(words), std::string::npos) << fault;
  }
  // other inputs are those of their slave
  const auto counters = [](const std::string& first, const std::string& second) {
    const auto slave = [](const std::string& name, const std::string& inputs) {
      return "  - {name: " + name + ", vendor: 1, product: 1, revision: 1, inputs: [" + inputs +
             "]}\n";
    };
    return fault_of(kAxis + drive("one", "m1", "cst") + kPanel + slave("force", first) +
                    slave("imu", second));
  };
  const std::string counter = "{object: 0x6020, bits: 32, is: sample_counter}";
  EXPECT_EQ(counters(counter, counter), "no error");
  EXPECT_NE(counters(counter + ", " + counter, counter)
                .find("slaves[3].inputs[1].is: slave 'force' gives this already in line 21"),
            std::string::npos);
}

}  // namespace
}  // namespace hg::config

#include "hg/config/bus/machine_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hg/core/error.h"

namespace hg::config {
namespace {

using ethercat::DriveMode;
using ethercat::Input;
using ethercat::Output;

const std::vector<std::string> kJoints = {"x", "m1"};

std::string drive(const std::string& name, const std::string& joint, const std::string& mode,
                  const std::string& outputs = "{object: 0x6071, bits: 16, is: target_torque}") {
  return "  - name: " + name + "\n    vendor: 0xFFFFFFFF\n    product: 0x10\n    revision: 3\n" +
         "    joint: " + joint + "\n    mode: " + mode + "\n" +
         "    outputs: [{object: 0x6040, bits: 16, is: control_word}, " + outputs +
         ", {object: 0x6060, bits: 8, is: mode}]\n" +
         "    inputs: [{object: 0x6041, bits: 16, is: status_word}, {object: 0x60E4, subindex: 1, "
         "bits: 32, is: link_position, scale: -1e-6, offset: 0.5}]\n";
}

const std::string kAxis =
    drive("axis", "x", "csv", "{object: 0x60FF, bits: 32, is: target_velocity}");

ethercat::Machine load(const std::string& slaves, const std::vector<std::string>& joints) {
  SourceReader reader({{"machine.yaml", "name: bench\nslaves:\n" + slaves}});
  return load_machine("machine.yaml", reader, joints);
}

std::string fault_of(const std::string& slaves) {
  try {
    load(slaves, kJoints);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(MachineFile, HasSlavesInTheOrderOfTheCable) {
  const ethercat::Machine machine = load(kAxis + drive("one", "m1", "cst"), kJoints);
  ASSERT_EQ(machine.slaves.size(), 2u);
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
  const ethercat::Machine machine = load(drive("one", "elbow", "cst"), {});
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
         "machine.yaml:15:12: slaves[1].joint: must be a joint of the device, got 'm2', did you "
         "mean 'm1'?");
  expect(kAxis, "joint 'm1' must have one drive, got 0");
  expect(kAxis + drive("one", "m1", "cst") + drive("two", "m1", "cst"),
         "joint 'm1' must have one drive, got 2");
  expect(kAxis + drive("axis", "m1", "cst"), "two slaves have the same name");
  expect(kAxis + drive("one", "m1", "csp"), "the target of its mode is missing");
  expect(kAxis + drive("one", "m1", "cst", "{object: 0x6071, bits: 15, is: target_torque}"),
         "must be whole bytes");
  expect(kAxis + drive("one", "m1", "cst", "{bits: 16, is: target_torque}"),
         "a gap (object 0) has no meaning");
  expect(kAxis + drive("one", "m1", "cst", "{object: 0x16071, bits: 16, is: target_torque}"),
         "object: must be a whole number from 0 to 65535, also as 0x1A, got '0x16071'");
  expect(kAxis + drive("one", "m1", "cst", "{object: 6.5, bits: 16, is: target_torque}"),
         "got '6.5'");
  expect(kAxis + drive("one", "m1", "cst", "{object: 0x6071, bits: 16, is: target_toque}"),
         "did you mean 'target_torque'?");
}

}  // namespace
}  // namespace hg::config

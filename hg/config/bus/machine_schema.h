/// Description of machine.yaml.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hg/config/bus/entry_schema.h"
#include "hg/config/bus/profile_schema.h"
#include "hg/config/schema.h"
#include "hg/device/ethercat/machine.h"

namespace hg::config {

inline constexpr std::uint32_t kAnyNumber32 = 0xFFFFFFFF;

/// Target that a drive in this mode gets.
inline ethercat::Output target_of(ethercat::DriveMode mode) {
  switch (mode) {
    case ethercat::DriveMode::kCsp:
      return ethercat::Output::kTargetPosition;
    case ethercat::DriveMode::kCsv:
      return ethercat::Output::kTargetVelocity;
    case ethercat::DriveMode::kCst:
      return ethercat::Output::kTargetTorque;
    case ethercat::DriveMode::kNone:
      break;
  }
  return ethercat::Output::kNothing;
}

template <class V>
void describe_drive(V& v, ethercat::Slave& slave, const std::vector<std::string>& joints) {
  using ethercat::DriveMode;
  const auto modes = choices_of<DriveMode>();
  v.name("joint", slave.joint, joints, "a joint of the device",
         "the joint or gantry axis that this drive moves");
  v.choice("mode", slave.mode, Choices<DriveMode>(modes),
           "how this drive is led (CiA 402): csp by positions, csv by velocities, cst by torques");
  v.rule(v.is_given("joint") == (slave.mode != DriveMode::kNone), "mode",
         "a drive has a joint and a mode, another slave neither");
}

template <class V>
void check_drive(V& v, const ethercat::Slave& slave) {
  using namespace ethercat;
  if (slave.mode == DriveMode::kNone) return;
  check_bits(v, slave.settings, "settings");
  check_bits(v, slave.outputs, "outputs");
  check_bits(v, slave.inputs, "inputs");
  const bool sets_mode =
      has_entry(slave.outputs, Output::kMode) ||
      std::ranges::any_of(slave.settings, [](const Setting& s) { return s.object == 0x6060; });
  v.rule(sets_mode, "outputs", "a drive needs an output 'mode', or a setting of object 0x6060");
  v.rule(has_entry(slave.outputs, Output::kControlWord), "outputs",
         "a drive needs an output 'control_word'");
  v.rule(has_entry(slave.outputs, target_of(slave.mode)), "outputs",
         "the target of its mode is missing: target_position for csp, target_velocity for csv, "
         "target_torque for cst");
  v.rule(has_entry(slave.inputs, Input::kStatusWord), "inputs",
         "a drive needs an input 'status_word'");
  v.rule(has_entry(slave.inputs, Input::kLinkPosition), "inputs",
         "a drive needs an input 'link_position'");
}

template <class V>
void describe(V& v, ethercat::Slave& slave, const std::vector<std::string>& joints) {
  v.words("name", slave.name, "name of this slave in messages", Need::kRequired);
  v.whole("vendor", slave.vendor, kAnyNumber32, "identity, as `bus scan` shows it",
          Need::kRequired);
  v.whole("product", slave.product, kAnyNumber32, "of this vendor", Need::kRequired);
  v.whole("revision", slave.revision, kAnyNumber32, "of this product", Need::kRequired);
  describe_drive(v, slave, joints);
  v.flag("synchronous", slave.is_synchronous,
         "gets sync pulses (SYNC0) of the distributed clocks, one per period");
  v.list(
      "settings",
      [&](auto& child) {
        ethercat::Setting setting;
        describe(child, setting);
        slave.settings.push_back(setting);
      },
      "objects that are written by SDO at every start, in this order, and read back");
  v.list(
      "outputs",
      [&](auto& child) {
        ethercat::Entry<ethercat::Output> entry;
        describe(child, entry);
        slave.outputs.push_back(entry);
      },
      "commands to this slave, in the order of its process data");
  v.list(
      "inputs",
      [&](auto& child) {
        ethercat::Entry<ethercat::Input> entry;
        describe(child, entry);
        slave.inputs.push_back(entry);
      },
      "its answers, likewise");
  v.rule(ethercat::bits_of(slave.outputs) % 8 == 0, "outputs", "must be whole bytes");
  v.rule(ethercat::bits_of(slave.inputs) % 8 == 0, "inputs", "must be whole bytes");
  check_drive(v, slave);
}

template <class V>
void describe_times(V& v, ethercat::Machine& machine) {
  v.number(
      "watchdog_s", machine.watchdog_s, {.lb = 1e-3, .ub = 6.5},
      "a slave that gets no outputs for so long leaves OP; set and verified at every start, of "
      "every slave with outputs; of a machine at most 0.1 s");
  v.number("answer_s", machine.answer_s, {.lb = 1e-5, .ub = 1.0},
           "a frame that takes longer to come back is lost; of a machine at most one period");
  v.number(
      "brake_closing_s", machine.brake_closing_s, {.lb = 0.0, .ub = 0.2},
      "from the command to close a brake until it holds: torques stay for so long, and drives on, "
      "where an output open_brakes leads the brakes; must be given for a machine with drives");
  v.flag("moves_with_frames", machine.moves_with_frames,
         "a simulated segment, which moves by one period with each frame: `run --fast` is allowed; "
         "all its slaves have vendors 0x00ffff00 to 0x00ffffff, which no maker has");
}

template <class V>
void describe(V& v, ethercat::Machine& machine, const std::vector<std::string>& joints) {
  v.words("name", machine.name, "name of the machine", Need::kRequired);
  describe_times(v, machine);
  v.list(
      "slaves",
      [&](auto& child) {
        ethercat::Slave slave;
        describe(child, slave, joints);
        machine.slaves.push_back(slave);
      },
      "all slaves in the order of the cable", Need::kRequired);
}

}  // namespace hg::config

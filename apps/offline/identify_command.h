/// `hapticgiant identify payload [FILE...]`: the payload beyond the force/torque sensor, from poses
/// at rest: of the simulated device, which takes them on its own, or from CSV files. `hapticgiant
/// identify friction RECORDING`: the friction of each joint, from a run. `hapticgiant identify
/// joints RECORDING`: stiffness and damping of each joint, or the delay of its drive. `hapticgiant
/// identify inertia RECORDING`: inertial parameters of the links.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/config/simulation/simulation.h"

namespace hg::apps {

class Command;

struct IdentifyArguments {
  std::vector<std::string> files;                          ///< CSV files; empty = simulate
  std::string device = "models/haptic_giant/device.yaml";  ///< device to simulate and compare with
  int poses = 12;  ///< number of poses taken on the simulated device
};

struct IdentifyRecordingArguments {
  std::string file;    ///< recording file
  std::string device;  ///< device.yaml; empty = that of the recording
  std::string json;    ///< file for all figures; empty = none
};

/// Identifies the payload and prints to stdout. Returns the exit code: 0, or 2 when the poses do
/// not suffice.
int identify_payload(const IdentifyArguments& arguments);
/// Identifies friction and prints to stdout. Returns the exit code: 0, or 2 when no joint moved
/// enough.
int identify_friction(const IdentifyRecordingArguments& arguments);

/// The device that --device names; nothing without it. Throws SetupError.
std::optional<config::SimulatedDeviceConfig> given_device(
    const IdentifyRecordingArguments& arguments);

/// Identifies stiffness, damping and delay and prints to stdout. Returns the exit code: 0, or 2
/// when no joint moved enough.
int identify_joints(const IdentifyRecordingArguments& arguments);

/// Identifies inertial parameters of the links and prints to stdout. Returns the exit code: 0, or 2
/// when the motion does not show enough of them.
int identify_inertia(const IdentifyRecordingArguments& arguments);

/// Adds the subcommands to the program; running it sets `exit_code`.
void add_identify(Command app, int& exit_code);

}  // namespace hg::apps

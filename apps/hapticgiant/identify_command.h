/// `hapticgiant identify payload [FILE...]`: what hangs beyond the force/torque sensor, from poses
/// at rest; of the simulated device, which takes them by itself, or from CSV files.
/// `hapticgiant identify friction RECORDING`: the friction of each joint, from a run.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

struct IdentifyArguments {
  std::vector<std::string> files;                          ///< CSV; empty: simulate
  std::string device = "models/haptic_giant/device.yaml";  ///< simulated, and compared with
  int poses = 12;                                          ///< to take on the simulated device
};

struct IdentifyFrictionArguments {
  std::string file;    ///< recording
  std::string device;  ///< device.yaml; empty: the one of the recording
  std::string json;    ///< file for all figures; empty = none
};

/// Prints to stdout. Returns the exit code: 0, or 2 when the poses do not suffice.
int identify_payload(const IdentifyArguments& arguments);
/// Likewise; 2 when no joint moved enough.
int identify_friction(const IdentifyFrictionArguments& arguments);

}  // namespace hg::apps

/// `hapticgiant identify payload [FILE...]`: what hangs beyond the force/torque sensor, from poses
/// at rest; of the simulated device, which takes them by itself, or from CSV files.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

struct IdentifyArguments {
  std::vector<std::string> files;                          ///< CSV; empty: simulate
  std::string device = "models/haptic_giant/device.yaml";  ///< simulated, and compared with
  int poses = 12;                                          ///< to take on the simulated device
};

/// Prints to stdout. Returns the exit code: 0, or 2 when the poses do not suffice.
int identify_payload(const IdentifyArguments& arguments);

}  // namespace hg::apps

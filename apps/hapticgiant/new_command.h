/// `hapticgiant new device|twin URDF`: a commented YAML file with values read from the URDF; `new
/// driver NAME`: a folder with a driver of one's own to fill in.
#pragma once

#include <string>

#include "hg/new/chain_part.h"

namespace hg::apps {

class Command;

struct NewArguments {
  new_files::ChainPart part;
  std::string output;               ///< file to write; empty: named after the URDF, in this folder
  std::string device;               ///< device that a twin is placed for; empty: the HapticGiant
  std::string drives = "position";  ///< drives of a device: position, torque or ideal
  bool may_overwrite = false;
};

/// Writes the file, and for a device that of its simulation, prints the next step, returns the exit
/// code. Throws SetupError when the URDF cannot be used or the file exists already.
int new_device(const NewArguments& arguments);
int new_twin(const NewArguments& arguments);

struct NewDriverArguments {
  std::string name;                 ///< of the driver and of its folder
  std::string language = "python";  ///< python or cpp
  std::string device;  ///< device.yaml or name of a shipped device; empty: not known yet
};

/// Writes the folder, prints the next steps, returns the exit code. Throws SetupError.
int new_driver(const NewDriverArguments& arguments);

/// Adds the subcommands to the program; running it sets `exit_code`.
void add_new(Command app, int& exit_code);

}  // namespace hg::apps

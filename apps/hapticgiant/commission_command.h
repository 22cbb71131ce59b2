/// The first motions of a new machine, step by step, with a person present.
#pragma once

#include "apps/hapticgiant/machine_options.h"

namespace hg::apps {

class Command;

struct CommissionArguments {
  MachineOptions machine;
  bool has_simulated_person = false;  ///< at a remote device, if that says that it is simulated
};

/// Exit code: 0 all is connected as the device file says, 1 something is not, or it was broken off.
/// Throws SetupError for bad input.
int commission(const CommissionArguments& options);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_commission(Command app, int& exit_code);

}  // namespace hg::apps

/// Tests brakes and stop inputs of a device, with an operator present.
#pragma once

#include "apps/hapticgiant/machine_options.h"

namespace hg::apps {

class Command;

/// Exit code: 0 passed, 1 something failed or the test was broken off, 3 the device has gone.
/// Throws SetupError for bad input.
int start_test(const MachineOptions& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_start_test(Command app, int& exit_code);

}  // namespace hg::apps

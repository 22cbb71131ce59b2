/// `hapticgiant simulate SCENARIO --remote --listen HOST:PORT`: the simulated remote machine of a
/// scenario's teleoperation for a leader elsewhere.
#pragma once

#include "apps/hapticgiant/simulate_command.h"

namespace hg::apps {

/// Serves one leader after the other until Ctrl-C; the machine stays where it is. Exit code as that
/// of simulate(). Throws SetupError.
int simulate_remote(const SimulateArguments& arguments);

}  // namespace hg::apps

/// `hapticgiant sweep`: many runs of a table of parameters (python/hapticgiant/sweep).
#pragma once

namespace CLI {
class App;
}

namespace hg::apps {

/// Adds the subcommand to the program; running it replaces the process by Python's.
void add_sweep(CLI::App& app);

}  // namespace hg::apps

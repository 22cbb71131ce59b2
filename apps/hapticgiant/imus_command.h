/// `hapticgiant imus`: where inertial sensors belong on a robot (python/hapticgiant/imus).
#pragma once

namespace CLI {
class App;
}

namespace hg::apps {

/// Adds the subcommand to the program; running it replaces the process by Python's.
void add_imus(CLI::App& app);

}  // namespace hg::apps

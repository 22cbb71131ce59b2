/// `hapticgiant study`: user studies, written in Python (python/hapticgiant/study).
#pragma once

namespace CLI {
class App;
}

namespace hg::apps {

/// Adds the subcommand to the program; running it replaces the process by Python's.
void add_study(CLI::App& app);

}  // namespace hg::apps

/// `hapticgiant export`: a recording as a table for other tools.
#pragma once

namespace CLI {
class App;
}

namespace hg::apps {

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_export(CLI::App& app, int& exit_code);

}  // namespace hg::apps

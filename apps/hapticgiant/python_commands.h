/// The subcommands that are written in Python: `sweep`, `imus`, `study`.
#pragma once

namespace CLI {
class App;
}

namespace hg::apps {

/// Adds the subcommands to the program; running one replaces the process by its Python part.
void add_python_commands(CLI::App& app);

}  // namespace hg::apps

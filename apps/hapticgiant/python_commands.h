/// The subcommands that are written in Python: `render`, `sweep`, `imus`, `study`.
#pragma once

namespace hg::apps {

class Command;

/// Adds the subcommands to the program; running one replaces the process by its Python part.
void add_python_commands(Command app);

}  // namespace hg::apps

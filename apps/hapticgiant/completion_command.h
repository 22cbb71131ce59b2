/// Scripts by which shells complete command lines of this program.
#pragma once

namespace hg::apps {

class Command;

/// Adds the subcommand to the program; running it prints the script of a shell.
void add_completion(Command app);

}  // namespace hg::apps

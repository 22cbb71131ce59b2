/// What every program of ours does around its command line.
#pragma once

#include <functional>

#include "apps/command_line/command.h"

namespace hg::apps {

/// Parses the command line of a program, to which `add` adds its subcommands; running one sets
/// `exit_code`. Returns the exit code of the process, after printing what was wrong.
int start(int argc, char** argv, const std::function<void(Command program, int& exit_code)>& add);

}  // namespace hg::apps

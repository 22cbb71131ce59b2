/// What words mean that people type where a subcommand stands: names of scenarios, files, and words
/// of other programs.
#pragma once

#include "apps/command_line/command.h"

namespace hg::apps {

Advices advices();

/// Adds the command "help", for the list of commands and for shells; with_help_as_option() runs it.
void add_help(Command app);

}  // namespace hg::apps

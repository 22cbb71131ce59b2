/// What every program of ours does around its command line.
#pragma once

#include <functional>
#include <string_view>

#include "apps/command_line/command.h"

namespace hg::apps {

/// First word of a command line that asks what the last one can be completed to; the scripts of
/// `hapticgiant completion` write it.
inline constexpr std::string_view kComplete = "__complete";
bool is_completion(int argc, char** argv);

/// The words of a command line, "help new twin" as "new twin --help", and a null at their end.
std::vector<char*> with_help_as_option(int argc, char** argv);

/// Parses the command line of a program, to which `add` adds its subcommands; running one sets
/// `exit_code`. Returns the exit code of the process, after printing what was wrong.
int start(int argc, char** argv, const std::function<void(Command program, int& exit_code)>& add,
          const Advices& advices = {});

}  // namespace hg::apps

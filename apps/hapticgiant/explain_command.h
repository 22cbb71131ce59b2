/// `hapticgiant explain`: describes a recorded run in words.
#pragma once

#include <string>

namespace hg::apps {

class Command;

/// Explains a recording on stdout. Exit code 0. Throws SetupError for bad input.
int explain_recording(const std::string& file);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_explain(Command app, int& exit_code);

}  // namespace hg::apps

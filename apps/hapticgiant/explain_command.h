/// `hapticgiant explain`: describes a recorded run in words.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace hg::apps {

/// Explains a recording on stdout. Exit code 0. Throws SetupError for bad input.
int explain_recording(const std::string& file);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_explain(CLI::App& app, int& exit_code);

}  // namespace hg::apps

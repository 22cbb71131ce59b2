/// `hapticgiant bridge NAME`: runs the bridge to another world of tools, a program of its own.
#pragma once

#include <CLI/CLI.hpp>

namespace hg::apps {

void add_bridge(CLI::App& app, int& exit_code);

}  // namespace hg::apps

/// `hapticgiant design FILE`: from requirements to a device that runs.
#pragma once

#include <CLI/CLI.hpp>

namespace hg::apps {

/// Lets the subcommand `design` of `app` search for a device where its first word is no subcommand
/// of its own; adds it where it is missing, so that it comes after all others.
void add_design_search(CLI::App& app);

}  // namespace hg::apps

/// Options of the commands that make, draw and compare experiments.
#pragma once

namespace CLI {
class App;
}

namespace hg::apps {

/// Adds cartesian, excavator, door, path, all and timing to the command `experiment`.
void add_paper_experiments(CLI::App& experiment, int& exit_code);

/// Adds the commands plot and compare to the program.
void add_plot_and_compare(CLI::App& app, int& exit_code);

}  // namespace hg::apps

/// Options of the commands that make, draw and compare experiments.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/hapticgiant/experiments/compare_command.h"
#include "apps/hapticgiant/experiments/paper_experiment_command.h"
#include "apps/hapticgiant/experiments/plot_command.h"

namespace hg::apps {

/// Arguments of these commands; must outlive parsing.
struct ExperimentsArguments {
  PaperExperimentArguments paper;
  PlotArguments plot;
  CompareArguments compare;
};

/// Adds cartesian, excavator, door, path, all and timing to the command `experiment`.
void add_paper_experiments(CLI::App& experiment, PaperExperimentArguments& arguments,
                           int& exit_code);

/// Adds the commands plot and compare to the program.
void add_plot_and_compare(CLI::App& app, ExperimentsArguments& arguments, int& exit_code);

}  // namespace hg::apps

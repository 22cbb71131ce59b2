/// One experiment on the full simulator: device with all its errors, scripted person, recording.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "hg/scenario/options.h"

namespace hg::apps {

/// An experiment of the paper: what it plays. What it shows is in
/// python/hapticgiant/report/experiments.py.
struct PaperExperiment {
  std::string_view name;      ///< name of the subcommand and of the figure's panels
  std::string_view scenario;  ///< scenario in models/scenarios
  std::string_view title;
  std::string_view source;  ///< place in the paper
  /// A second scenario, played into a folder of its name, shown below the first; empty = none
  std::string_view also = {};
};

/// How an experiment is played.
struct ExperimentRun {
  scenario::ScenarioOptions world;
  std::optional<double> duration_s;  ///< duration, s; unset = until the script has played
  std::string folder;                ///< of the results
};

/// Plays an experiment as fast as possible into its folder: recording.mcap,
/// where recordings are available, run.json, signals.npy, and summary and computing times in
/// timing.json. The same arguments write the same bytes, but for timing.json. `command` repeats the
/// run. Throws SetupError.
void play_experiment(const PaperExperiment& experiment, const ExperimentRun& arguments,
                     const std::string& command);

}  // namespace hg::apps

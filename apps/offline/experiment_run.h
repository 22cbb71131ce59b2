/// One experiment on the full simulator: device with all its errors, scripted person, recording.
#pragma once

#include <string>
#include <string_view>

#include "apps/hapticgiant/run_command.h"
#include "hg/config/simulation/scenario.h"

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

/// Plays an experiment as fast as possible into the folder `arguments.recordings`: recording.mcap,
/// where recordings are available, run.json, signals.npy, and summary and computing times in
/// timing.json. The same arguments write the same bytes, but for timing.json. `command` repeats the
/// run. Throws SetupError.
void play_experiment(const PaperExperiment& experiment, const RunArguments& arguments,
                     const std::string& command);

}  // namespace hg::apps

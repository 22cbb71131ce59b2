/// `hapticgiant experiment cartesian|excavator|door|path|all|timing`: the paper's experiments.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hg::apps {

struct PaperExperimentArguments {
  std::string out = "experiments";    ///< output folder, with a subfolder per experiment
  std::string law;                    ///< law, "gauss", "paper" or "both"; empty = the device's
  std::string bounds;                 ///< bounds, "recoverable" or "paper"; empty = the device's
  std::optional<std::uint64_t> seed;  ///< seed of noise and tremor; unset = the device's
  std::optional<double> duration_s;   ///< duration; unset = until the script has played
  std::string docs;                   ///< folder of documentation to refresh; empty = none
  /// Rates of the timing experiment
  std::vector<double> rates_Hz = {1000.0, 2000.0, 5000.0, 10000.0};
};

/// Exit code: 0 all as expected, 1 an event is missing or out of its window or a limit was
/// exceeded, 3 a fault. Throws SetupError for bad input.
int run_paper_experiments(const PaperExperimentArguments& arguments,
                          const std::vector<std::string>& names);

/// Measures the computation time of a cycle; exit code 0.
int timing_experiment(const PaperExperimentArguments& arguments);

}  // namespace hg::apps

/// `hapticgiant experiment cartesian|excavator|door|path|all|timing`: the paper's experiments.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hg::apps {

struct PaperExperimentArguments {
  std::string out = "experiments";    ///< folder; one per experiment is made in it
  std::string law;                    ///< "gauss", "paper" or "both"; empty = the device's
  std::string bounds;                 ///< "recoverable" or "paper"; empty = the device's
  std::optional<std::uint64_t> seed;  ///< of noise and tremor; unset: the device's
  std::optional<double> duration_s;   ///< unset: until the script has played
  std::string docs;                   ///< folder of documentation to refresh; empty = none
  std::vector<double> rates_Hz = {1000.0, 2000.0, 5000.0, 10000.0};  ///< of timing
};

/// Exit code: 0 all as expected, 1 an event is missing or not where it was expected or a limit was
/// exceeded, 3 a fault. Throws SetupError for bad input.
int run_paper_experiments(const PaperExperimentArguments& arguments,
                          const std::vector<std::string>& names);

/// How long a cycle computes; exit code 0.
int timing_experiment(const PaperExperimentArguments& arguments);

}  // namespace hg::apps

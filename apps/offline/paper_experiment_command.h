/// `hapticgiant experiment cartesian|excavator|door|path|all|timing`: the paper's experiments.
///
/// Exit code: 0 all as expected, 1 an event is missing or out of its window or a limit was
/// exceeded, 3 a fault, 4 (kNotWritten) no report.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/hapticgiant/report.h"

namespace hg::apps {

class Command;

struct PaperExperimentArguments {
  std::string out = "experiments";    ///< output folder, with a subfolder per experiment
  std::string law;                    ///< preset, or "both" gauss and paper; empty = the device's
  std::optional<std::uint64_t> seed;  ///< seed of noise and tremor; unset = the device's
  std::optional<double> duration_s;   ///< duration; unset = until the script has played
  std::string docs;                   ///< folder of documentation to refresh; empty = none
  /// Device and twin of the timing experiment instead of its own; the others refuse a device
  std::string device, twin;
  /// Rates of the timing experiment
  std::vector<double> rates_Hz = {1000.0, 2000.0, 5000.0, 10000.0};
};

/// Measures the computation time of a cycle and makes the report; the exit code.
int timing_experiment(const PaperExperimentArguments& arguments);

/// The report on `results`, written into `folder`, which has the data.
Report report_in(const std::string& folder, const std::string& docs,
                 const nlohmann::ordered_json& results);

/// Adds cartesian, excavator, door, path, all and timing to the command `experiment`.
void add_paper_experiments(Command experiment, int& exit_code);

}  // namespace hg::apps

/// One experiment on the full simulator: device with all its errors, scripted person, recording.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/hapticgiant/experiments/figure_data.h"
#include "apps/hapticgiant/experiments/paper_experiments.h"
#include "apps/hapticgiant/experiments/run_table.h"
#include "apps/hapticgiant/run_command.h"
#include "hg/config/simulation/scenario.h"

namespace hg::apps {

/// An expected event and its result.
struct EventResult {
  const EventRule* rule = nullptr;
  std::optional<double> found_s;
  const EventWindow* window = nullptr;            ///< expected window; nullptr = any time
  double window_from_s = 0.0, window_to_s = 0.0;  ///< window in time of the run

  bool is_as_expected() const noexcept {
    return found_s && (window == nullptr || (*found_s >= window_from_s && *found_s <= window_to_s));
  }
};

struct ExperimentResult {
  const PaperExperiment* experiment = nullptr;
  std::unique_ptr<config::Scenario> scenario;  ///< scenario to which `table` and `events` refer
  std::unique_ptr<RunTable> table;             ///< table of every sample
  std::vector<EventResult> events;
  nlohmann::ordered_json summary;     ///< summary as of run --summary, without computation times
  nlohmann::ordered_json timing;      ///< computation times of the summary
  std::vector<std::string> failures;  ///< failures in words; empty = all as expected
  bool has_fault = false;

  /// Events that happened, in their order, by the names of the paper.
  std::vector<Mark> marks() const;
  /// Time of an event by the name of its rule; NaN where it is missing.
  double time_of(std::string_view event) const;
};

/// Progress callback: simulated and total time, s.
using SimulatedTime = std::function<void(double done_s, double total_s)>;

/// Runs an experiment as fast as possible and records into `arguments.recordings`/recording.mcap,
/// where recordings are available; the same arguments write the same bytes. Throws SetupError.
ExperimentResult run_experiment(const PaperExperiment& experiment, const RunArguments& arguments,
                                const SimulatedTime& progress);

}  // namespace hg::apps

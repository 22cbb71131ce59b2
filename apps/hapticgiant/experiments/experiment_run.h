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
#include "hg/config/scenario.h"

namespace hg::apps {

/// An expected event and what became of it.
struct EventResult {
  const evaluation::EventRule* rule = nullptr;
  std::optional<double> found_s;
  const EventWindow* window = nullptr;            ///< nullptr: any time will do
  double window_from_s = 0.0, window_to_s = 0.0;  ///< of the run

  bool is_as_expected() const noexcept {
    return found_s && (window == nullptr || (*found_s >= window_from_s && *found_s <= window_to_s));
  }
};

struct ExperimentResult {
  const PaperExperiment* experiment = nullptr;
  std::unique_ptr<config::Scenario> scenario;  ///< which `table` and `events` refer to
  std::unique_ptr<RunTable> table;             ///< every sample
  std::vector<EventResult> events;
  nlohmann::ordered_json summary;     ///< of run --summary, without times of computation
  nlohmann::ordered_json timing;      ///< what is left of it
  std::vector<std::string> failures;  ///< in words; empty: all as expected
  bool has_fault = false;

  /// Events that happened, in their order, by the names of the paper.
  std::vector<Mark> marks() const;
  /// Time of an event by the name of its rule; NaN where it is missing.
  double time_of(std::string_view event) const;
};

/// Told now and then: seconds that have been simulated, and of how many.
using SimulatedTime = std::function<void(double done_s, double total_s)>;

/// Runs it as fast as it can and records into `arguments.recordings`/recording.mcap, where
/// recordings are available; the same arguments write the same bytes. Throws SetupError.
ExperimentResult run_experiment(const PaperExperiment& experiment, const RunArguments& arguments,
                                const SimulatedTime& progress);

}  // namespace hg::apps

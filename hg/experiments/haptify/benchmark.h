/// Everything that `hapticgiant haptify` measures, as numbers of each run. Statistics, tables and
/// texts are made from them by python/hapticgiant/report.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/runs.h"

namespace hg::haptify {

struct HaptifyOptions {
  std::uint64_t seed = 1;  ///< seed of the first repetition; the others follow
  int repetitions = 5;
  bool is_quick = false;  ///< quick run: few samples, short runs
};

struct Benchmark {
  std::string device;  ///< name of the device
  /// Where its handle was held and moved, in words; empty: where that of the HapticGiant is
  std::string place;
  /// Measurements by name. Each has the list `runs`, with condition and result of every run in SI
  /// units, and `settings`, the values that all its runs share. `failure` of a run says why its
  /// result is invalid; empty = valid. "not possible: ...": the device cannot do it. null stands
  /// for infinite and undefined numbers.
  nlohmann::json measurements;
  bool has_failures = false;  ///< a run has failed
};

/// Runs the benchmark. `scenario`: a hand that leads a free body (models/scenarios/walk.yaml). The
/// same scenario and options give the same numbers. Throws SetupError when the twin is not a free
/// body.
Benchmark measure(const config::Scenario& scenario, const HaptifyOptions& options,
                  experiments::Runs& runs);

/// Measures what has a design goal with `options.repetitions` seeds, at three heights of the handle
/// and, where a person holds it, in three hands: Table III is for the middle of the workspace, this
/// for the worst case. `light` is `scenario` with the lightest body that the device can render: it
/// is used for the forces of free space and of a surface without friction. Errors as measure().
Benchmark measure_goals(const config::Scenario& scenario, const config::Scenario& light,
                        const HaptifyOptions& options, experiments::Runs& runs);

}  // namespace hg::haptify

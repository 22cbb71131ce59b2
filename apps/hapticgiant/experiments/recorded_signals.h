/// Content of a recording: its scenario, events, signals and evaluation.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/hapticgiant/experiments/figure_data.h"
#include "apps/hapticgiant/experiments/run_table.h"
#include "hg/config/simulation/scenario.h"
#include "hg/recording/recording_reader.h"

namespace hg::apps {

/// Hash of the state after a cycle. Cycles lost in the recording are left out.
struct CycleHash {
  std::uint64_t cycle, hash;
};

struct RecordedSignals {
  std::unique_ptr<config::Scenario> scenario;  ///< scenario to which `table` refers
  std::unique_ptr<RunTable> table;
  std::vector<Mark> marks;  ///< recorded events, by the names of the paper
  /// Summary as of run --summary, for the content of the recording
  nlohmann::ordered_json summary;
  std::vector<CycleHash> hashes;
  recording::ReadResult read;  ///< result of reading the file
  std::vector<recording::NamedText> configuration;

  double rate_Hz() const { return scenario->device.model.rate_Hz; }
};

/// Reads a recording with one row of signals per `period_s`. Throws SetupError.
RecordedSignals read_signals(const std::filesystem::path& file, double period_s);

}  // namespace hg::apps

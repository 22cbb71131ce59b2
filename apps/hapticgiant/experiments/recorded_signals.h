/// A recording read again: its scenario, events, signals and judgement.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/hapticgiant/experiments/figure_data.h"
#include "apps/hapticgiant/experiments/run_table.h"
#include "hg/config/scenario.h"
#include "hg/recording/recording_reader.h"

namespace hg::apps {

/// Of the state after a cycle. Cycles that the recording has lost are left out.
struct CycleHash {
  std::uint64_t cycle, hash;
};

struct RecordedSignals {
  std::unique_ptr<config::Scenario> scenario;  ///< which `table` refers to
  std::unique_ptr<RunTable> table;
  std::vector<Mark> marks;         ///< events as recorded, by the names of the paper
  nlohmann::ordered_json summary;  ///< as of run --summary, of what the recording holds
  std::vector<CycleHash> hashes;
  recording::ReadResult read;  ///< what of the file
  std::vector<recording::NamedText> configuration;

  double rate_Hz() const { return scenario->device.rate_Hz; }
};

/// One row of signals per `period_s`. Throws SetupError.
RecordedSignals read_signals(const std::filesystem::path& file, double period_s);

}  // namespace hg::apps

/// What `hapticgiant bench` has measured, as it was measured: python/hapticgiant/report/bench.py
/// makes tables and figures of it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/cycle_table.h"
#include "bench/growth.h"
#include "bench/law_table.h"
#include "bench/solver_table.h"

namespace hg::bench {

struct BenchResults {
  nlohmann::ordered_json machine;  ///< describe_machine(), and the version of the program
  int passes = 1;
  /// Largest number of problems of a set and of cycles of a scenario; null = all
  nlohmann::ordered_json most_problems, most_cycles;
  std::vector<std::string> remarks;  ///< what could not be measured, one sentence each
  std::vector<SolverSet> solver;
  std::vector<CycleTimes> cycles;
  std::vector<GrowthRow> growth;
  std::vector<LawRun> laws;
};

/// Times of the cycles of a scenario and of their stages, lists of whole nanoseconds.
nlohmann::ordered_json json_of(const CycleTimes& times);

/// All results; times are lists of whole nanoseconds.
nlohmann::ordered_json to_json(const BenchResults& results);

}  // namespace hg::bench

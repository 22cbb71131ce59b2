/// Output files of `hapticgiant bench`: JSON, CSV tables, figures.
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
  nlohmann::ordered_json machine;
  std::vector<bench::SolverSet> solver;
  std::vector<bench::CycleTimes> cycles;
  std::vector<bench::GrowthRow> growth;
  std::vector<bench::GrowthExponent> exponents;
  std::vector<bench::LawRun> laws;
};

nlohmann::ordered_json to_json(const BenchResults& results);

/// CSV text of flat objects with the same keys; the first line has the keys. Null becomes empty.
std::string to_csv(const nlohmann::ordered_json& rows);

/// Creates the folder if it is missing. Throws SetupError; "" means "no folder".
void check_folder(const std::string& folder);

/// Writes machine.txt, and per table a CSV file and a figure. Throws SetupError.
void write_files(const std::string& folder, const BenchResults& results);

}  // namespace hg::bench

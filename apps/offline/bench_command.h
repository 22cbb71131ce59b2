/// `hapticgiant bench`: solver, control cycle and laws, measured in one run;
/// docs/reports/benchmarks.md.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

class Command;

struct BenchArguments {
  std::vector<std::string> scenarios = {"door", "free_space", "excavator"};
  bool is_quick = false;  ///< fewer problems and passes: for a first look
  std::string json;       ///< JSON file; empty = none
  std::string out;        ///< folder of tables and figures; empty = none
  std::string docs;       ///< folder of documentation to refresh; empty = none
};

/// Prints four tables: our solver and the paper's cascade on the problems of the scenarios and of
/// the reference data; Cycle::step by stages; growth with the size of a problem; both laws with
/// both kinds of bounds. Exit code 0, or 1 when an expected event is missing, a device was stopped
/// by a fault, or our solver has failed or was wrong. Throws SetupError for bad input.
int bench(const BenchArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_bench(Command app, int& exit_code);

}  // namespace hg::apps

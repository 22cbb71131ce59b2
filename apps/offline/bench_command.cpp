#include "apps/offline/bench_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/subcommand.h"
#include "bench/bench_results.h"
#include "bench/machine.h"
#include "bench/scenario.h"
#include "hg/config/shipped_files.h"

namespace hg::apps {
namespace {

using rendering::Bounds;
using rendering::Law;

constexpr std::array<std::pair<Law, Bounds>, 4> kVariants = {{{Law::kGauss, Bounds::kRecoverable},
                                                              {Law::kPaper, Bounds::kRecoverable},
                                                              {Law::kGauss, Bounds::kPaper},
                                                              {Law::kPaper, Bounds::kPaper}}};
// rows of the cycle table besides the scenarios, unless some are named
constexpr std::array<const char*, 2> kLargeTwins = {"chain_20", "chain_30"};
constexpr std::array<int, 6> kVariables = {6, 12, 24, 48, 84, 120};
constexpr std::array<int, 5> kLevels = {1, 2, 5, 10, 20};

/// Amount of work.
struct Effort {
  int passes;
  std::size_t problems;  ///< largest number of problems of a set
  std::size_t cycles;    ///< largest number of cycles of a scenario
  int variables;         ///< largest number of variables of the growth table
};
constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
constexpr Effort kFull = {.passes = 5, .problems = kAll, .cycles = kAll, .variables = 120};
constexpr Effort kQuick = {.passes = 2, .problems = 500, .cycles = 2000, .variables = 24};

struct NamedScenario {
  std::string name;
  config::Scenario scenario;

  bool takes(Law law) const { return law != Law::kPaper || scenario.device.model.n_m == 6; }
};

// Shows the current measurement until the next one replaces it.
void announce(const std::string& what) {
  if (isatty(STDERR_FILENO) != 0) draw_error(fmt::format("measuring {} ...", what));
}

bool are_ours_right(const bench::SolverSet& set) {
  for (const bench::SolverRun& run : set.runs) {
    if (run.solver != "cascade" && run.failures + run.wrong.value_or(0) > 0) return false;
  }
  return true;
}

bool measure_solvers(const std::vector<NamedScenario>& scenarios,
                     std::vector<bench::ProblemSource>& reference, const Effort& effort,
                     bench::BenchResults& results) {
  const bench::BaselineSolve baseline = bench::find_baseline();
  bool all_right = true;
  const auto measure = [&](bench::ProblemSource& source) {
    announce(source.name());
    results.solver.push_back(bench::measure_solvers(source, baseline, effort.passes));
    all_right = all_right && are_ours_right(results.solver.back());
  };
  for (const auto& [law, bounds] : {kVariants.front(), kVariants.back()}) {
    for (const NamedScenario& named : scenarios) {
      if (!named.takes(law)) continue;
      const config::Scenario scenario = bench::with_law(named.scenario, law, bounds);
      const std::string name = fmt::format("{}, {}, {}", named.name, rendering::to_string(law),
                                           rendering::to_string(bounds));
      bench::ProblemSource source(name, scenario, effort.problems);
      measure(source);
    }
  }
  for (bench::ProblemSource& source : reference) measure(source);
  if (baseline == nullptr) {
    results.remarks.push_back(fmt::format("cascade: {}", bench::kHowToGetBaseline));
  }
  if (reference.empty()) {
    results.remarks.emplace_back("no reference problems: tests/reference is not there");
  }
  return all_right;
}

void measure_cycles(const std::vector<NamedScenario>& scenarios, const Effort& effort,
                    bench::BenchResults& results) {
  for (const NamedScenario& named : scenarios) {
    announce(named.name);
    results.cycles.push_back(bench::measure_cycle(
        named.name, bench::with_law(named.scenario, Law::kGauss, Bounds::kRecoverable),
        effort.passes, effort.cycles));
  }
}

bool measure_growth(const Effort& effort, bench::BenchResults& results) {
  bool is_solved = true;
  for (const int variables : kVariables) {
    for (const int levels : kLevels) {
      if (variables > effort.variables || levels > 2 * variables) continue;
      announce(fmt::format("n = {}", variables));
      results.growth.push_back(bench::measure_growth(variables, levels, effort.passes));
      is_solved = is_solved && results.growth.back().failures == 0;
    }
  }
  return is_solved;
}

bool play_laws(const std::vector<NamedScenario>& scenarios, bench::BenchResults& results) {
  bool all_well = true;
  for (const NamedScenario& named : scenarios) {
    for (const auto& [law, bounds] : kVariants) {
      if (!named.takes(law)) {
        results.remarks.push_back(named.name + ": law paper needs six manipulator joints");
        continue;
      }
      announce(named.name);
      results.laws.push_back(
          bench::play_law(named.name, bench::with_law(named.scenario, law, bounds)));
      all_well = all_well && results.laws.back().is_well();
    }
  }
  return all_well;
}

// null: no limit
nlohmann::ordered_json limit_of(std::size_t most) {
  return most == kAll ? nlohmann::ordered_json() : nlohmann::ordered_json(most);
}

}  // namespace

int bench(const BenchArguments& arguments) {
  std::vector<NamedScenario> scenarios;
  for (const std::string& name : arguments.scenarios)
    scenarios.push_back({name, bench::bench_scenario(name)});
  const Effort& effort = arguments.is_quick ? kQuick : kFull;
  std::vector<bench::ProblemSource> reference;
  for (const auto& file : bench::reference_files(config::models_root())) {
    reference.emplace_back(file, effort.problems);
  }
  check_writable(arguments.json, kJson);
  if (!arguments.docs.empty()) check_writable(arguments.docs + "/benchmarks.md", kMarkdown);
  check_report_program();  // before minutes of measurements
  const std::string file =
      arguments.out.empty() ? "" : (std::filesystem::path(arguments.out) / "results.json").string();
  if (!file.empty()) make_folder(arguments.out);
  check_writable(file);

  bench::BenchResults results = {.machine = bench::describe_machine(),
                                 .passes = effort.passes,
                                 .most_problems = limit_of(effort.problems),
                                 .most_cycles = limit_of(effort.cycles)};
  results.machine["version"] = kVersion;
  const bool is_right = measure_solvers(scenarios, reference, effort, results);
  std::vector<NamedScenario> with_large = scenarios;
  if (arguments.scenarios == BenchArguments{}.scenarios) {
    for (const char* name : kLargeTwins) with_large.push_back({name, bench::bench_scenario(name)});
  }
  measure_cycles(with_large, effort, results);
  const bool is_solved = measure_growth(effort, results);
  const bool is_well = play_laws(scenarios, results);

  if (isatty(STDERR_FILENO) != 0) draw_error("");
  const nlohmann::ordered_json measured = to_json(results);
  if (!file.empty())
    write_output(file,
                 measured.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  return become_reports({{.results = measured,
                          .folder = arguments.out,
                          .docs = arguments.docs,
                          .files = {{"bench.json", arguments.json}},
                          .kept = file.empty() ? "" : file + " has the results\n",
                          .exit_code = is_right && is_solved && is_well ? 0 : 1}});
}

void add_bench(Command app, int& exit_code) {
  const auto arguments = std::make_shared<BenchArguments>();
  const Command command = add_offline(app, "bench");
  command.footer(
      "Examples:\n"
      "  hapticgiant bench                        everything, on the three scenarios\n"
      "  hapticgiant bench door --quick           a first look, in seconds\n"
      "  hapticgiant bench --out results --json results/bench.json");
  command.add_option("scenarios", arguments->scenarios, "scenario files or names")
      .capture_default_str();
  command.add_flag("--quick", arguments->is_quick, "fewer problems and passes");
  command.add_option("--json", arguments->json, "write all tables as JSON to this file");
  command.add_option("-o,--out", arguments->out,
                     "write tables (CSV) and figures (SVG) to this folder");
  command.add_option("--docs", arguments->docs,
                     "refresh the page benchmarks.md of this folder (make bench)");
  command.callback([arguments, &exit_code] { exit_code = bench(*arguments); });
}

}  // namespace hg::apps

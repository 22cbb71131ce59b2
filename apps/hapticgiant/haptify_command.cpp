#include "apps/hapticgiant/haptify_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/experiments/figure_program.h"
#include "apps/hapticgiant/haptify_report.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/studies/haptify/benchmark.h"
#include "hg/studies/haptify/goals.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

// on a terminal in place; elsewhere one line per measurement
void tell(const std::string& what, std::size_t done, std::size_t total) {
  const bool is_terminal = isatty(STDERR_FILENO) != 0;
  if (is_terminal) {
    draw_error(done < total ? fmt::format("{}: {} of {}", what, done, total) : "");
  } else if (done == total) {
    print_error("{}: {} runs\n", what, total);
  }
}

std::string command_of(const HaptifyArguments& arguments) {
  const haptify::Options& options = arguments.options;
  std::string command = fmt::format("hapticgiant haptify --seed {}", options.seed);
  if (options.repetitions != haptify::Options{}.repetitions) {
    command += fmt::format(" --repetitions {}", options.repetitions);
  }
  if (!arguments.simulation.empty()) command += " --simulation " + arguments.simulation;
  if (!arguments.twin.empty()) command += " --twin " + arguments.twin;
  if (arguments.only_goals) command += " --goals";
  return command + (options.is_quick ? " --quick" : "");
}

// writes results.json and what is made of it; the user is told of `page`
void report(const HaptifyArguments& arguments, const nlohmann::ordered_json& results,
            const std::string& page) {
  const fs::path folder = arguments.out;
  write_output((folder / "results.json").string(), results.dump() + "\n");
  write_report(folder, arguments.docs);
  print_out(fmt::format("\nreport      {}\n", (folder / page).string()));
}

int write_goals(const HaptifyArguments& arguments) {
  const config::Scenario scenario =
      make_scenario({.scenario = "walk", .simulation = arguments.simulation});
  const config::Scenario light =
      make_scenario({.scenario = "walk",
                     .twin = arguments.twin.empty() ? "light" : arguments.twin,
                     .simulation = arguments.simulation});
  const haptify::Benchmark goals = haptify::measure_goals(scenario, light, arguments.options, tell);
  print_out(goals_text(goals));
  report(arguments, results_json(goals, "goals", command_of(arguments)), "goals.md");
  return goals.failures.empty() ? 0 : 1;
}

}  // namespace

int run_haptify(const HaptifyArguments& arguments) {
  const fs::path folder = arguments.out;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw SetupError(folder.string() + ": cannot be made: " + error.message());
  check_report_program();  // before minutes of measurements
  print_out(fmt::format(
      "HapticGiant {}  Haptify benchmark, Table III of the paper, on a simulated machine\n\n",
      kVersion));
  if (arguments.only_goals) return write_goals(arguments);
  const config::Scenario scenario = make_scenario(
      {.scenario = "walk", .twin = arguments.twin, .simulation = arguments.simulation});
  const haptify::Benchmark result = haptify::measure(scenario, arguments.options, tell);
  print_out(haptify_text(result));
  report(arguments, results_json(result, "haptify", command_of(arguments)), "report.html");
  return result.failures.empty() ? 0 : 1;
}

}  // namespace hg::apps

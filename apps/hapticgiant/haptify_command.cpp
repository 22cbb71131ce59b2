#include "apps/hapticgiant/haptify_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "apps/hapticgiant/experiments/docs_page.h"
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

int write_goals(const HaptifyArguments& arguments) {
  const config::Scenario scenario =
      make_scenario({.scenario = "walk", .simulation = arguments.simulation});
  const config::Scenario light =
      make_scenario({.scenario = "walk",
                     .twin = arguments.twin.empty() ? "light" : arguments.twin,
                     .simulation = arguments.simulation});
  const haptify::Benchmark goals = haptify::measure_goals(scenario, light, arguments.options, tell);
  print_out(goals_text(goals));
  const fs::path folder = arguments.out;
  const std::string markdown = goals_markdown(goals, command_of(arguments));
  write_output((folder / "goals.md").string(), "# Goals\n\n" + markdown);
  write_output((folder / "goals.csv").string(), table_csv(haptify::goals_table(goals)));
  write_output((folder / "goals_runs.csv").string(), repetitions_csv(goals));
  if (!arguments.docs.empty()) refresh_page(arguments.docs, "goals", markdown, {});
  print_out(fmt::format("\nreport      {}\n", (folder / "goals.md").string()));
  return goals.failures.empty() ? 0 : 1;
}

}  // namespace

int run_haptify(const HaptifyArguments& arguments) {
  const fs::path folder = arguments.out;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw SetupError(folder.string() + ": cannot be made: " + error.message());
  print_out(fmt::format(
      "HapticGiant {}  Haptify benchmark, Table III of the paper, on a simulated machine\n\n",
      kVersion));
  if (arguments.only_goals) return write_goals(arguments);
  const config::Scenario scenario = make_scenario(
      {.scenario = "walk", .twin = arguments.twin, .simulation = arguments.simulation});
  const haptify::Benchmark result = haptify::measure(scenario, arguments.options, tell);
  const std::string command = command_of(arguments);

  print_out(haptify_text(result));
  const auto write = [&](const std::string& name, const std::string& text) {
    write_output((folder / name).string(), text);
  };
  write("report.html", haptify_html(result, command));
  const std::string markdown = haptify_markdown(result, command);
  write("report.md", "# Haptify\n\n" + markdown);
  write("table.tex", haptify_latex(result));
  write("haptify.csv", haptify_csv(result));
  write("repetitions.csv", repetitions_csv(result));
  for (const haptify::Table& table : result.tables) write(table.id + ".csv", table_csv(table));
  if (!arguments.docs.empty()) refresh_page(arguments.docs, "haptify", markdown, {});
  print_out(fmt::format("\nreport      {}\n", (folder / "report.html").string()));
  return result.failures.empty() ? 0 : 1;
}

}  // namespace hg::apps

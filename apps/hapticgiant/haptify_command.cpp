#include "apps/hapticgiant/haptify_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "apps/hapticgiant/experiments/docs_page.h"
#include "apps/hapticgiant/haptify_report.h"
#include "apps/hapticgiant/option_checks.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/scenario/options.h"
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
      scenario::load({.scenario = "walk", .simulation = arguments.simulation});
  const config::Scenario light =
      scenario::load({.scenario = "walk",
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
  const config::Scenario scenario = scenario::load(
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

void add_haptify(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<HaptifyArguments>();
  CLI::App* command = app.add_subcommand(
      "haptify",
      "Table III of the paper on the simulated device: how good it is to hold; minutes.");
  command->footer(
      "Examples:\n"
      "  hapticgiant haptify                      report in haptify/report.html\n"
      "  hapticgiant haptify --quick              a look, in seconds\n"
      "  hapticgiant haptify --seed 7 --repetitions 10 --out results\n"
      "  hapticgiant haptify --quick --simulation as_published\n"
      "  hapticgiant haptify --goals --repetitions 16   the worst of seeds, heights and hands");
  command->add_option("--out", arguments->out, "folder of the report")->capture_default_str();
  command->add_option("--seed", arguments->options.seed, "of the first repetition")
      ->check(whole_number(0.0))
      ->capture_default_str();
  command->add_option("--repetitions", arguments->options.repetitions, "with other seeds")
      ->check(whole_number(2.0, 100.0))
      ->capture_default_str();
  command->add_flag("--quick", arguments->options.is_quick, "few samples and short runs");
  command->add_flag("--goals", arguments->only_goals,
                    "only what the device shall reach, at three heights in three hands");
  command->add_option(
      "--twin", arguments->twin,
      "free body that is held (with --goals: the light one), as a file or a shipped name");
  command->add_option("--simulation", arguments->simulation, kSimulationHelp);
  command->add_option("--docs", arguments->docs,
                      "refresh the page haptify.md of this folder (make experiments)");
  command->callback([arguments, &exit_code] { exit_code = run_haptify(*arguments); });
}

}  // namespace hg::apps

#include "apps/hapticgiant/haptify_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/option_checks.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/scenario/options.h"
#include "hg/studies/haptify/benchmark.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

// on a terminal in place; elsewhere one line per measurement
void show_progress(const std::string& what, std::size_t done, std::size_t total) {
  const bool is_terminal = isatty(STDERR_FILENO) != 0;
  if (is_terminal) {
    draw_error(done < total ? fmt::format("{}: {} of {}", what, done, total) : "");
  } else if (done == total) {
    print_error("{}: {} runs\n", what, total);
  }
}

std::string command_of(const HaptifyArguments& arguments) {
  const haptify::HaptifyOptions& options = arguments.options;
  std::string command = fmt::format("hapticgiant haptify --seed {}", options.seed);
  if (options.repetitions != haptify::HaptifyOptions{}.repetitions) {
    command += fmt::format(" --repetitions {}", options.repetitions);
  }
  if (!arguments.device.empty()) command += " --device " + arguments.device;
  if (!arguments.simulation.empty()) command += " --simulation " + arguments.simulation;
  if (!arguments.twin.empty()) command += " --twin " + arguments.twin;
  if (arguments.only_goals) command += " --goals";
  return command + (options.is_quick ? " --quick" : "");
}

haptify::Benchmark measure_goals(const HaptifyArguments& arguments) {
  const config::Scenario scenario = scenario::load(
      {.scenario = "walk", .device = arguments.device, .simulation = arguments.simulation});
  const config::Scenario light =
      scenario::load({.scenario = "walk",
                      .device = arguments.device,
                      .twin = arguments.twin.empty() ? "light" : arguments.twin,
                      .simulation = arguments.simulation});
  return haptify::measure_goals(scenario, light, arguments.options, show_progress);
}

haptify::Benchmark measure_all(const HaptifyArguments& arguments) {
  const config::Scenario scenario = scenario::load({.scenario = "walk",
                                                    .device = arguments.device,
                                                    .twin = arguments.twin,
                                                    .simulation = arguments.simulation});
  return haptify::measure(scenario, arguments.options, show_progress);
}

nlohmann::ordered_json results_json(const HaptifyArguments& arguments,
                                    const haptify::Benchmark& measured) {
  const haptify::HaptifyOptions& options = arguments.options;
  nlohmann::ordered_json json = {{"kind", arguments.only_goals ? "goals" : "haptify"},
                                 {"version", kVersion},
                                 {"command", command_of(arguments)},
                                 {"device", measured.device},
                                 {"seed", options.seed},
                                 {"repetitions", options.repetitions},
                                 {"is_quick", options.is_quick},
                                 {"measurements", measured.measurements}};
  if (!measured.place.empty()) json["place"] = measured.place;
  return json;
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
  const haptify::Benchmark measured =
      arguments.only_goals ? measure_goals(arguments) : measure_all(arguments);
  print_out(report_text(folder, results_json(arguments, measured), "report.txt", arguments.docs));
  print_out(fmt::format("\nreport      {}\n",
                        (folder / (arguments.only_goals ? "goals.md" : "report.html")).string()));
  return measured.has_failures ? 1 : 0;
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
      "  hapticgiant haptify --quick --device arm.yaml\n"
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
  command->add_option("--device", arguments->device,
                      "device.yaml instead of the reference device's");
  command->add_option("--simulation", arguments->simulation, kSimulationHelp);
  command->add_option("--docs", arguments->docs,
                      "refresh the page haptify.md of this folder (make experiments)");
  command->callback([arguments, &exit_code] { exit_code = run_haptify(*arguments); });
}

}  // namespace hg::apps

#include "apps/offline/haptify_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/subcommand.h"
#include "hg/core/error.h"
#include "hg/experiments/haptify/benchmark.h"
#include "hg/scenario/options.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kParts = 40;  // the measurements differ in length: each part has some of all

// The command that gives the same results, in words.
std::vector<std::string> command_of(const HaptifyArguments& arguments) {
  const haptify::HaptifyOptions& options = arguments.options;
  std::vector<std::string> words = {"haptify", "--seed", std::to_string(options.seed)};
  if (options.repetitions != haptify::HaptifyOptions{}.repetitions) {
    words.insert(words.end(), {"--repetitions", std::to_string(options.repetitions)});
  }
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--device", arguments.device);
  add("--simulation", arguments.simulation);
  add("--twin", arguments.twin);
  if (arguments.only_goals) words.emplace_back("--goals");
  if (options.is_quick) words.emplace_back("--quick");
  return words;
}

// The same for another working directory.
std::vector<std::string> part_command(const HaptifyArguments& arguments) {
  HaptifyArguments handed = arguments;
  for (std::string* file : {&handed.device, &handed.simulation, &handed.twin}) {
    *file = file_or_name(*file);
  }
  return command_of(handed);
}

config::Scenario walk_with(const HaptifyArguments& arguments, const std::string& twin) {
  return scenario::load({.scenario = "walk",
                         .device = arguments.device,
                         .twin = twin,
                         .simulation = arguments.simulation});
}

nlohmann::ordered_json results_json(const HaptifyArguments& arguments,
                                    const haptify::Benchmark& measured) {
  const haptify::HaptifyOptions& options = arguments.options;
  nlohmann::ordered_json json = {
      {"kind", arguments.only_goals ? "goals" : "haptify"},
      {"version", kVersion},
      {"command", fmt::format("hapticgiant {}", fmt::join(command_of(arguments), " "))},
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
  const bool is_part = !arguments.played.part.empty();
  const fs::path folder = arguments.out;
  if (!is_part) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw SetupError(folder.string() + ": cannot be made: " + error.message());
    check_report_program();  // before minutes of measurements
    check_sweep_program(arguments.played);
    print_out(fmt::format(
        "HapticGiant {}  Haptify benchmark, Table III of the paper, on a simulated machine\n\n",
        kVersion));
  }
  Campaign campaign = {.command = part_command(arguments), .parts = kParts};
  haptify::Benchmark measured;
  if (arguments.only_goals) {
    const std::string light = arguments.twin.empty() ? "light" : arguments.twin;
    campaign.scenarios = {walk_with(arguments, ""), walk_with(arguments, light)};
    campaign.play = [&](experiments::Runs& runs) {
      measured = haptify::measure_goals(campaign.scenarios[0], campaign.scenarios[1],
                                        arguments.options, runs);
    };
  } else {
    campaign.scenarios = {walk_with(arguments, arguments.twin)};
    campaign.play = [&](experiments::Runs& runs) {
      measured = haptify::measure(campaign.scenarios[0], arguments.options, runs);
    };
  }
  if (play_campaign(campaign, arguments.played)) return 0;
  const nlohmann::ordered_json results = results_json(arguments, measured);
  const fs::path file = folder / "results.json";
  write_output(file.string(),
               results.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  return become_reports(
      {{.results = results,
        .folder = folder.string(),
        .docs = arguments.docs,
        .last_line =
            fmt::format("\nreport      {}\n",
                        (folder / (arguments.only_goals ? "goals.md" : "report.html")).string()),
        .kept = file.string() + " has the results\n"}});
}

void add_haptify(Command app, int& exit_code) {
  const auto arguments = std::make_shared<HaptifyArguments>();
  const Command command = add_offline(app, "haptify");
  command.footer(
      "Examples:\n"
      "  hapticgiant haptify                      report in haptify/report.html\n"
      "  hapticgiant haptify --quick              a look, in seconds\n"
      "  hapticgiant haptify --seed 7 --repetitions 10 --out results\n"
      "  hapticgiant haptify --quick --simulation as_published\n"
      "  hapticgiant haptify --quick --device arm.yaml\n"
      "  hapticgiant haptify --goals --repetitions 16   the worst of seeds, heights and hands");
  command.add_option("-o,--out", arguments->out, "folder of the report").capture_default_str();
  command.add_option("--seed", arguments->options.seed, "of the first repetition")
      .check(whole_number(0.0))
      .capture_default_str();
  command.add_option("--repetitions", arguments->options.repetitions, "with other seeds")
      .check(whole_number(2.0, 100.0))
      .capture_default_str();
  command.add_flag("--quick", arguments->options.is_quick, "few samples and short runs");
  command.add_flag("--goals", arguments->only_goals,
                   "only what the device shall reach, at three heights in three hands");
  command.add_option(
      "--twin", arguments->twin,
      "free body that is held (with --goals: the light one), as a file or a shipped name");
  command.add_option("--device", arguments->device,
                     "device.yaml instead of the reference device's");
  command.add_option("--simulation", arguments->simulation, kSimulationHelp);
  add_campaign_options(command, arguments->played);
  command.add_option("--docs", arguments->docs,
                     "refresh the page haptify.md of this folder (make experiments)");
  command.callback([arguments, &exit_code] { exit_code = run_haptify(*arguments); });
}

}  // namespace hg::apps

#include "apps/offline/faults_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/subcommand.h"
#include "hg/core/error.h"
#include "hg/core/scratch_folder.h"
#include "hg/experiments/moved_scenario.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/options.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::apps {
namespace {

// The scenarios with their options.
struct Played {
  std::vector<scenario::ScenarioOptions> options;
  std::vector<config::Scenario> scenarios;
};

Played scenarios_of(const FaultsArguments& arguments) {
  Played played;
  if (arguments.scenarios.empty()) {
    const scenario::ScenarioOptions options = {
        .scenario = "walk", .device = arguments.device, .twin = arguments.twin};
    return {{options}, {experiments::moved_scenario(options)}};
  }
  for (const std::string& name : arguments.scenarios) {
    played.options.push_back(
        {.scenario = name, .device = arguments.device, .twin = arguments.twin});
    played.scenarios.push_back(scenario::load(played.options.back()));
  }
  return played;
}

void check_script(const config::Scenario& scenario, const std::string& name) {
  const Interval times = experiments::fault_times(scenario);
  if (times.lb <= times.ub) return;
  throw SetupError(name +
                   ": faults are played in scenarios with a script that continues for two seconds "
                   "after the grasp");
}

constexpr int kCasesOfAPart = 12;  // a process needs as long to begin as half a case takes

std::vector<std::string> command_of(const FaultsArguments& arguments) {
  std::vector<std::string> words = {"faults", "--cases", std::to_string(arguments.campaign.cases),
                                    "--seed", std::to_string(arguments.campaign.seed)};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, file_or_name(value)});
  };
  for (const std::string& scenario : arguments.scenarios) add("--scenario", scenario);
  add("--device", arguments.device);
  add("--twin", arguments.twin);
  return words;
}

}  // namespace

int faults(FaultsArguments arguments) {
  if (arguments.scenarios.empty() && arguments.device.empty() && arguments.twin.empty()) {
    arguments.scenarios = {"door", "free_space", "excavator", "walk"};
  }
  const auto [options, scenarios] = scenarios_of(arguments);
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    check_script(scenarios[i],
                 arguments.scenarios.empty() ? scenarios[i].title : options[i].scenario);
  }
  check_writable(arguments.json, kJson);
  check_writable(arguments.markdown, kMarkdown);
  if (!arguments.docs.empty()) check_writable(arguments.docs + "/fault_campaign.md", kMarkdown);
  const bool is_part = !arguments.played.part.empty();
  if (arguments.json.empty() && !is_part) check_report_program();  // before minutes of runs
  if (!is_part) check_sweep_program(arguments.played);
  const ScratchFolder scratch;
  std::vector<recording::RecordingInfo> recordings;
  if (recording::recording_available()) {
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
      recordings.push_back(scenario::recording_info(scenarios[i], options[i]));
      recordings.back().folder = scratch.path();
      recordings.back().version = kVersion;
    }
  }
  if (!is_part) {
    print_out(fmt::format("HapticGiant {}  {} injected faults, seed {}\n\n", kVersion,
                          arguments.campaign.cases, arguments.campaign.seed));
  }
  experiments::Campaign campaign;
  const auto play = [&, &scenarios = scenarios](experiments::Runs& runs) {
    campaign = experiments::run_campaign(scenarios, arguments.campaign, recordings, runs);
  };
  const std::size_t parts = 1 + (arguments.campaign.cases - 1) / kCasesOfAPart;
  if (play_campaign({command_of(arguments), parts, scenarios, play}, arguments.played)) return 0;
  const nlohmann::ordered_json results = to_json(campaign);
  write_json(arguments.json, results);  // which the report replaces by the one with verdicts
  return become_reports(
      {{.results = results,
        .docs = arguments.docs,
        .files = {{"faults.json", arguments.json}, {"report.md", arguments.markdown}},
        .kept = arguments.json.empty() ? "" : arguments.json + " has the results\n"}});
}

void add_faults(Command app, int& exit_code) {
  const auto arguments = std::make_shared<FaultsArguments>();
  const Command command = add_offline(app, "faults");
  command.footer(
      "Examples:\n"
      "  hapticgiant faults\n"
      "  hapticgiant faults --cases 60 --seed 7 --scenario door --json faults.json\n"
      "  hapticgiant faults --device arm.yaml --twin gate.yaml");
  command.add_option("--cases", arguments->campaign.cases, "number of runs")
      .check(whole_number(1.0, 1e9));
  command.add_option("--seed", arguments->campaign.seed, "of scenarios, times and sizes")
      .check(whole_number(0.0));
  command.add_option("--scenario", arguments->scenarios, "scenarios with a script");
  command.add_option(
      "--device", arguments->device,
      "device.yaml instead of the scenarios'; without --scenario a hand moves it through its "
      "workspace");
  command.add_option("--twin", arguments->twin,
                     "twin.yaml, or the name of a shipped one, that is moved; without "
                     "--scenario joint by joint");
  add_campaign_options(command, arguments->played);
  command.add_option("--json", arguments->json, "write all cases as JSON to this file");
  command.add_option("--markdown", arguments->markdown, "write the table as a page to this file");
  command.add_option("--docs", arguments->docs,
                     "refresh the page fault_campaign.md of this folder (make experiments)");
  command.callback([arguments, &exit_code] { exit_code = faults(*arguments); });
}

}  // namespace hg::apps

#include "apps/offline/paper_experiment_command.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/experiment_run.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::array<PaperExperiment, 4> kExperiments = {
    {{"cartesian", "free_space", "Cartesian admittance", "Fig. 6, section VII-A"},
     {"excavator", "excavator", "Excavator", "Fig. 8, section VII-B"},
     {"door", "door", "Door", "Fig. 9, section VII-C", "walk_through"},
     {"path", "path", "Path following", "Section VII-D (the path task)"}}};

// command that repeats the run
std::string command_of(const PaperExperimentArguments& arguments, std::string_view name) {
  std::string command = fmt::format("hapticgiant experiment {}", name);
  if (!arguments.law.empty()) command += " --law " + arguments.law;
  if (arguments.seed) command += fmt::format(" --seed {}", *arguments.seed);
  if (arguments.duration_s) command += fmt::format(" --duration {:g}", *arguments.duration_s);
  return command;
}

// Plays an experiment; what its report is made of.
Report run_one(const PaperExperiment& experiment, const PaperExperimentArguments& arguments) {
  print_out(fmt::format("\n{} ({})\n", experiment.title, experiment.source));
  const auto folder_of = [&](std::string_view name) { return fs::path(arguments.out) / name; };
  std::vector<std::string> runs;
  for (const std::string& law : arguments.law == "both" ? std::vector<std::string>{"gauss", "paper"}
                                                        : std::vector{arguments.law}) {
    ExperimentRun run;
    run.world.seed = arguments.seed;
    run.world.law = law;
    run.duration_s = arguments.duration_s;
    const auto play = [&](const PaperExperiment& played) {
      const fs::path folder = folder_of(played.name);
      run.folder = (arguments.law == "both" ? folder / law : folder).string();
      runs.push_back(fs::absolute(run.folder).string());
      run.world.scenario = played.scenario;
      make_folder(run.folder);
      play_experiment(played, run, command_of(arguments, experiment.name));
    };
    play(experiment);
    if (!experiment.also.empty()) {
      play({experiment.also, experiment.also, experiment.title, experiment.source});
    }
  }
  return report_in(folder_of(experiment.name).string(), arguments.docs,
                   {{"kind", experiment.name}, {"runs", runs}});
}

// The worst code of all.
int run_paper_experiments(const PaperExperimentArguments& arguments,
                          const std::vector<PaperExperiment>& experiments) {
  if (!arguments.device.empty()) {
    throw SetupError(
        "--device: the paper's experiments are figures of the HapticGiant; what another device can "
        "do show `hapticgiant haptify --device FILE` and `hapticgiant experiment seeds --device "
        "FILE`");
  }
  print_out(
      fmt::format("HapticGiant {}  the paper's experiments, on a simulated machine\n", kVersion));
  std::vector<Report> reports;
  for (const PaperExperiment& experiment : experiments) {
    reports.push_back(run_one(experiment, arguments));
  }
  return become_reports(reports);
}

void add_options(Command command, PaperExperimentArguments& arguments) {
  add_law_option(command, arguments.law, {"both"});
  command.add_option("--seed", arguments.seed, "of noise and tremor: the same seed, the same files")
      .check(whole_number(0.0));
  command.add_option("-o,--out", arguments.out, "folder; one per experiment is made in it")
      .capture_default_str();
  command
      .add_option("--duration", arguments.duration_s,
                  "seconds, to cut it short; default: until the script has played")
      .check(number_that("more than 0", [](double value) { return value > 0.0; }));
  command.add_option("--docs", arguments.docs,
                     "refresh the figures in the pages of this folder (make experiments)");
}

}  // namespace

Report report_in(const std::string& folder, const std::string& docs,
                 const nlohmann::ordered_json& results) {
  return {.results = results,
          .folder = folder,
          .docs = docs,
          .last_line = fmt::format("report      {}\n", (fs::path(folder) / "report.html").string()),
          .kept = folder + " has the data\n"};
}

void add_paper_experiments(Command experiment, int& exit_code) {
  const auto arguments = std::make_shared<PaperExperimentArguments>();
  const auto add = [&](std::string_view name, const std::string& text,
                       const std::vector<PaperExperiment>& played) {
    const Command command = experiment.add_subcommand(std::string(name), text);
    add_options(command, *arguments);
    command.add_option("--device", arguments->device,
                       "refused: these are figures of the HapticGiant; names what shows another "
                       "device");
    command.callback(
        [arguments, &exit_code, played] { exit_code = run_paper_experiments(*arguments, played); });
  };
  for (const PaperExperiment& each : kExperiments) {
    add(each.name, std::string(each.title) + " of the paper, " + std::string(each.source), {each});
  }
  add("all", "these four, one after the other", {kExperiments.begin(), kExperiments.end()});
  const Command timing = experiment.add_subcommand(
      "timing", "computing time of a cycle beside the paper's, section VII-A; minutes");
  add_options(timing, *arguments);
  timing.add_option("--device", arguments->device,
                    "device.yaml instead of the reference device's; a hand moves it through its "
                    "workspace");
  timing.add_option("--twin", arguments->twin,
                    "twin.yaml, or the name of a shipped one, that is moved");
  timing.add_option("--rates", arguments->rates_Hz, "control rates, Hz")
      .delimiter(',')
      .capture_default_str();
  timing.callback([arguments, &exit_code] { exit_code = timing_experiment(*arguments); });
}

}  // namespace hg::apps

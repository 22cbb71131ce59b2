#include "apps/hapticgiant/faults_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/paths.h"
#include "apps/hapticgiant/process_faults.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/scratch_folder.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/scenario/assembly.h"

namespace hg::apps {
namespace {

int process_faults(const FaultsArguments& arguments) {
  const std::vector<ProcessCase> cases =
      play_process_faults(arguments.scenarios, arguments.repetitions, arguments.campaign.seed);
  print_out(to_text(cases));
  write_json(arguments.json, to_json(cases));
  return std::ranges::all_of(cases, &ProcessCase::is_good) ? 0 : 1;
}

}  // namespace

int faults(const FaultsArguments& arguments) {
  std::vector<config::Scenario> scenarios;
  for (const std::string& name : arguments.scenarios) {
    scenarios.push_back(config::load_scenario(find_scenario(name)));
    const Interval times = studies::fault_times(scenarios.back());
    if (times.lb > times.ub) {
      throw SetupError(
          name +
          ": faults are played in scenarios with a script that goes on for two seconds "
          "after the grasp");
    }
  }
  check_writable(arguments.json, kJson);
  check_writable(arguments.markdown, kMarkdown);
  if (arguments.plays_processes) return process_faults(arguments);
  const ScratchFolder scratch;
  std::vector<recording::RecordingInfo> recordings;
  if (recording::recording_available()) {
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
      RunArguments run;
      run.world.scenario = arguments.scenarios[i];
      run.recordings = scratch.path();
      recordings.push_back(recording_info(scenarios[i], run));
    }
  }
  print_out(fmt::format("HapticGiant {}  {} faults on purpose, seed {}\n\n", kVersion,
                        arguments.campaign.cases, arguments.campaign.seed));
  const studies::Campaign campaign =
      studies::run_campaign(scenarios, arguments.campaign, recordings, progress_of("faults"));
  print_out(studies::to_text(campaign));
  if (!arguments.markdown.empty()) {
    write_output(arguments.markdown, studies::to_markdown(campaign));
  }
  write_json(arguments.json, studies::to_json(campaign));
  return studies::is_passed(campaign) ? 0 : 1;
}

}  // namespace hg::apps

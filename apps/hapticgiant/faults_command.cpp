#include "apps/hapticgiant/faults_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/paths.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/status_line.h"
#include "apps/hapticgiant/version.h"
#include "hg/assembly/assembly.h"
#include "hg/core/error.h"

namespace hg::apps {

int faults(const FaultsArguments& arguments) {
  std::vector<config::Scenario> scenarios;
  for (const std::string& name : arguments.scenarios) {
    scenarios.push_back(config::load_scenario(find_scenario(name)));
    if (assembly::planned_duration_s(scenarios.back()) == 0.0) {
      throw SetupError(name + ": faults are played in scenarios with a script");
    }
  }
  check_writable(arguments.json);
  print_out(fmt::format("HapticGiant {}  {} faults on purpose, seed {}\n\n", kVersion,
                        arguments.campaign.cases, arguments.campaign.seed));
  const experiments::Campaign campaign =
      experiments::run_campaign(scenarios, arguments.campaign, progress_of("faults"));
  print_out(experiments::to_text(campaign));
  if (!arguments.json.empty()) {
    nlohmann::ordered_json json = experiments::to_json(campaign);
    json["version"] = kVersion;
    write_output(arguments.json, json.dump(2) + "\n");
  }
  return experiments::is_passed(campaign) ? 0 : 1;
}

}  // namespace hg::apps

#include "apps/hapticgiant/scenario_options.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "hg/config/law_names.h"
#include "hg/config/shipped_files.h"
#include "hg/config/simulation/script_schema.h"
#include "hg/core/error.h"
#include "hg/scenario/run/plan_options.h"

namespace hg::apps {
namespace {

using config::ShippedFile;

// Names that shells complete; none where there is no models/.
std::vector<std::string> names_in(std::vector<ShippedFile> (*shipped)()) {
  std::vector<std::string> names;
  try {
    for (const ShippedFile& file : shipped()) names.push_back(file.name);
  } catch (const SetupError&) {
    return {};
  }
  return names;
}

void print_list(const char* heading, const std::vector<ShippedFile>& files) {
  print_out("{}\n", heading);
  for (const ShippedFile& file : files) print_out("  {:<22} {}\n", file.name, file.title);
}

}  // namespace

void print_shipped() {
  print_list("Scenarios: hapticgiant run SCENARIO", config::shipped_scenarios());
  print_list("\nDevices: hapticgiant run --device DEVICE --twin TWIN", config::shipped_devices());
  print_list("\nTwins; those of an arm stand where it reaches them", config::shipped_twins());
}

void add_scenario_options(Command command, scenario::ScenarioOptions& world) {
  command
      .add_option("scenario", world.scenario,
                  "scenario file, or the name of a shipped one, as door or fr3/open_drawer "
                  "(run --list)")
      .suggest([] { return names_in(config::shipped_scenarios); })
      .capture_default_str();
  command
      .add_option("--device", world.device,
                  "device.yaml, or the name of a shipped device (fr3), instead of the scenario's")
      .suggest([] { return names_in(config::shipped_devices); });
  command
      .add_option("--twin", world.twin,
                  "twin.yaml, or the name of a shipped one (light, fr3/drawer), instead of the "
                  "scenario's")
      .suggest([] { return names_in(config::shipped_twins); });
  command
      .add_option("--surfaces", world.surfaces,
                  "scenario whose virtual surfaces are met instead of the scenario's own; or none")
      .suggest([] {
        std::vector<std::string> names = names_in(config::shipped_scenarios);
        std::erase_if(names, [](const std::string& name) {
          return !config::has_surfaces(config::find_scenario(name));
        });
        return names;
      });
  command.add_option("--plant", world.plant, "elastic: with springs, friction and delays; or ideal")
      .one_of({"elastic", "ideal"});
  command.add_option("--simulation", world.simulation, kSimulationHelp);
  command.add_option("--sensors", world.sensors, "real: with errors and noise; or ideal")
      .one_of({"real", "ideal"});
  command.add_option("--hand", world.hand, "stiffness of the simulated hand")
      .one_of(names_of(config::kHandPresets));
  command
      .add_option("--seed", world.seed,
                  "seed of noise and tremor: the same seed gives the same run")
      .check(number_that(scenario::kSeedRule));
  command.add_option("--step", world.step_s, "largest step of the simulated machine, s")
      .check(number_that(scenario::kStepRule));
  command
      .add_option("--set", world.changes,
                  "another value for a key of scenario, device, simulation, twin or script, as "
                  "twin.mass_scale=2; may be given several times")
      .allow_extra_args(false);
  command.add_option("--user", world.user, "file or name of a script, mouse or none");
  command.add_option("--rate-hz", world.rate_Hz, "control rate, 100..20000; default: the device's")
      .check(number_that(scenario::kRateRule));
}

void add_law_option(Command command, std::string& law, std::vector<std::string> more) {
  std::vector<std::string> names = names_of(config::kLawPresets);
  names.insert(names.end(), more.begin(), more.end());
  const std::vector<std::string> all = names;
  const std::string last = names.back();
  names.pop_back();
  command
      .add_option("--law", law,
                  fmt::format("{} or {}; default: the device's", fmt::join(names, ", "), last))
      .one_of(all);
  command.retire_option("--bounds", "use --law paper_bounds for law and bounds of the paper");
  command.retire_option("--gantry", "use --law gantry for a gantry that the law leads");
  command.retire_option("--braking", "use --law gauss for limits that brake alone");
  command.retire_option("--passivity", "use --set device.passivity.reaction=act");
}

}  // namespace hg::apps

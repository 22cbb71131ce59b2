#include "apps/hapticgiant/scenario_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/hapticgiant/option_checks.h"
#include "hg/config/law_names.h"
#include "hg/config/simulation/script_schema.h"

namespace hg::apps {

void add_scenario_options(CLI::App& command, scenario::ScenarioOptions& world) {
  command
      .add_option(
          "scenario", world.scenario,
          "scenario file, or door, excavator, free_space, path, walk, surfaces, ARM/SCENARIO")
      ->capture_default_str();
  command.add_option(
      "--device", world.device,
      "device.yaml, or the name of a shipped device (fr3), instead of the scenario's");
  command.add_option(
      "--twin", world.twin,
      "twin.yaml, or the name of a shipped one (light, fr3/drawer), instead of the scenario's");
  command
      .add_option("--plant", world.plant, "elastic: with springs, friction and delays; or ideal")
      ->check(CLI::IsMember({"elastic", "ideal"}));
  command.add_option("--simulation", world.simulation, kSimulationHelp);
  command.add_option("--sensors", world.sensors, "real: with errors and noise; or ideal")
      ->check(CLI::IsMember({"real", "ideal"}));
  command.add_option("--hand", world.hand, "stiffness of the simulated hand")
      ->check(CLI::IsMember(names_of(config::kHandPresets)));
  command
      .add_option("--seed", world.seed,
                  "seed of noise and tremor: the same seed gives the same run")
      ->check(whole_number(0.0));
  command.add_option("--step", world.step_s, "largest step of the simulated machine, s")
      ->check(number_that("from 1e-5 to 2e-3",
                          [](double value) { return value >= 1e-5 && value <= 2e-3; }));
  command
      .add_option("--set", world.changes,
                  "another value for a key of scenario, device, simulation, twin or script, as "
                  "twin.mass_scale=2; may be given several times")
      ->allow_extra_args(false);
  command.add_option("--user", world.user, "file or name of a script, mouse or none");
  command.add_option("--rate-hz", world.rate_Hz, "control rate, 100..20000; default: the device's")
      ->check(number_that("from 100 to 20000",
                          [](double value) { return value >= 100.0 && value <= 20000.0; }));
}

void add_law_option(CLI::App& command, std::string& law, std::vector<std::string> more) {
  std::vector<std::string> names = names_of(config::kLawPresets);
  names.insert(names.end(), more.begin(), more.end());
  const CLI::IsMember check(names);
  const std::string last = names.back();
  names.pop_back();
  command
      .add_option("--law", law,
                  fmt::format("{} or {}; default: the device's", fmt::join(names, ", "), last))
      ->check(check);
  const auto refuse = [&](const char* option, const char* instead) {
    const auto fail = [=](const std::string&) {
      throw CLI::ValidationError(option, std::string("is no option any more: ") + instead);
    };
    command.add_option_function<std::string>(option, fail)->group("");
  };
  refuse("--bounds", "use --law as_published for law and bounds of the paper");
  refuse("--gantry", "use --law gantry for a gantry that the law leads");
  refuse("--braking", "use --law together for limits that brake together");
  refuse("--passivity", "use --set device.passivity.reaction=act");
}

}  // namespace hg::apps

#include "apps/hapticgiant/scenario_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/hapticgiant/option_checks.h"
#include "hg/config/law_names.h"
#include "hg/config/simulation/script_schema.h"

namespace hg::apps {
void add_choice(CLI::App& command, const char* option, std::string& value,
                std::vector<std::string> names, const char* what) {
  const CLI::IsMember check(names);
  const std::string last = names.back();
  names.pop_back();
  command
      .add_option(
          option, value,
          fmt::format("{} or {}{}; default: the device's", fmt::join(names, ", "), last, what))
      ->check(check);
}

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
      ->check(number_that(scenario::kSeedRule));
  command.add_option("--step", world.step_s, "largest step of the simulated machine, s")
      ->check(number_that(scenario::kStepRule));
  command
      .add_option("--set", world.changes,
                  "another value for a key of scenario, device, simulation, twin or script, as "
                  "twin.mass_scale=2; may be given several times")
      ->allow_extra_args(false);
  command.add_option("--user", world.user, "file or name of a script, mouse or none");
  command.add_option("--rate-hz", world.rate_Hz, "control rate, 100..20000; default: the device's")
      ->check(number_that(scenario::kRateRule));
}

void add_law_options(CLI::App& command, scenario::ScenarioOptions& world) {
  add_choice(command, "--law", world.law, names_of(config::kLaws));
  add_choice(command, "--bounds", world.bounds, names_of(config::kBounds));
  add_choice(command, "--gantry", world.gantry, names_of(config::kGantries));
  add_choice(command, "--braking", world.braking, names_of(config::kBrakings));
}

void add_passivity_option(CLI::App& command, scenario::ScenarioOptions& world) {
  add_choice(command, "--passivity", world.passivity, names_of(config::kPassivityReactions),
             " on a hand and a device that shake each other");
}

}  // namespace hg::apps

#include "apps/hapticgiant/scenario_options.h"

#include <CLI/CLI.hpp>

#include "apps/hapticgiant/option_checks.h"

namespace hg::apps {

void add_scenario_options(CLI::App& command, scenario::ScenarioOptions& world) {
  command
      .add_option("scenario", world.scenario,
                  "scenario file, or door, excavator, free_space, path, walk, surfaces")
      ->capture_default_str();
  command.add_option("--device", world.device, "device.yaml instead of the scenario's");
  command.add_option("--twin", world.twin,
                     "twin.yaml, or the name of a shipped one, instead of the scenario's");
  command.add_option("--plant", world.plant, "elastic: all that makes haptics hard; or ideal")
      ->check(CLI::IsMember({"elastic", "ideal"}));
  command.add_option("--simulation", world.simulation, kSimulationHelp);
  command.add_option("--sensors", world.sensors, "real: with all their errors; or ideal")
      ->check(CLI::IsMember({"real", "ideal"}));
  command.add_option("--hand", world.hand, "how hard the simulated hand is made")
      ->check(CLI::IsMember({"relaxed", "normal", "stiff"}));
  command.add_option("--seed", world.seed, "of noise and tremor: the same seed, the same run")
      ->check(whole_number(0.0));
  command.add_option("--step", world.step_s, "largest step of the simulated machine, s")
      ->check(number_that("from 1e-5 to 2e-3",
                          [](double value) { return value >= 1e-5 && value <= 2e-3; }));
  command.add_option("--user", world.user, "file or name of a script, mouse or none");
  command.add_option("--rate-hz", world.rate_Hz, "control rate, 100..20000; default: the device's")
      ->check(number_that("from 100 to 20000",
                          [](double value) { return value >= 100.0 && value <= 20000.0; }));
}

}  // namespace hg::apps

/// Options of all commands that play a scenario.
#pragma once

#include <string>
#include <vector>

#include "hg/scenario/options.h"

namespace hg::apps {

class Command;

/// Help text of --simulation.
inline constexpr char kSimulationHelp[] =
    "simulation.yaml instead of the device's, or the NAME of a simulation_NAME.yaml beside it: "
    "as_published, harder";

/// Adds scenario, device, twin, person and what is simulated; not the law. `world` must outlive
/// parsing.
void add_scenario_options(Command command, scenario::ScenarioOptions& world);

/// Adds law, bounds, gantry and braking. `world` must outlive parsing.
void add_law_options(Command command, scenario::ScenarioOptions& world);
void add_passivity_option(Command command, scenario::ScenarioOptions& world);

/// Adds an option that takes one of `names`; its help lists them, then `what` they are about.
/// Without it the device decides.
void add_choice(Command command, const char* option, std::string& value,
                std::vector<std::string> names, const char* what = "");

/// Names of a list of choices such as config::kLaws.
template <typename List>
std::vector<std::string> names_of(const List& choices) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.emplace_back(choice.name);
  return names;
}

}  // namespace hg::apps

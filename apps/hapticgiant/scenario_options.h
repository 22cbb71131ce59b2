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

/// Prints the shipped scenarios, devices and twins.
void print_shipped();

/// Adds --law, which takes a preset or one of `more`, and refuses the options of earlier versions.
/// `law` must outlive parsing.
void add_law_option(Command command, std::string& law, std::vector<std::string> more = {});

/// Names of a list of choices such as config::kLawPresets.
template <typename List>
std::vector<std::string> names_of(const List& choices) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.emplace_back(choice.name);
  return names;
}

}  // namespace hg::apps

/// Options of all commands that play a scenario.
#pragma once

#include "hg/scenario/options.h"

namespace CLI {
class App;
}

namespace hg::apps {

/// Help text of --simulation.
inline constexpr char kSimulationHelp[] =
    "simulation.yaml instead of the device's, or the NAME of a simulation_NAME.yaml beside it: "
    "as_published, harder";

/// Adds scenario, device, twin, person and what is simulated; not the law. `world` must outlive
/// parsing.
void add_scenario_options(CLI::App& command, scenario::ScenarioOptions& world);

/// Adds law, bounds, gantry, braking and passivity. `world` must outlive parsing.
void add_law_options(CLI::App& command, scenario::ScenarioOptions& world);

}  // namespace hg::apps

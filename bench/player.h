/// The player of experiments, for measurements of laws.
#pragma once

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/player.h"

namespace hg::bench {

using experiments::Player;

/// The scenario with the law and the bounds put into its device.
config::Scenario with_law(config::Scenario scenario, rendering::Law law, rendering::Bounds bounds);

}  // namespace hg::bench

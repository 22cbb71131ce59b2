/// The player of experiments, for measurements of laws.
#pragma once

#include "hg/config/simulation/scenario.h"
#include "hg/studies/player.h"

namespace hg::bench {

using studies::Player;

/// The scenario with the law and the bounds put into its device.
config::Scenario with_law(config::Scenario scenario, rendering::Law law, rendering::Bounds bounds);

}  // namespace hg::bench

/// A scripted scenario for any device and twin.
#pragma once

#include "hg/config/simulation/scenario.h"
#include "hg/scenario/options.h"

namespace hg::experiments {

/// A hand moves the twin of `options` on the device of `options`: a free body on random strokes
/// for 15 s through the place of the device (place.h), any other twin joint by joint through its
/// ranges. Its title names both. The scenario of the options does not matter. Throws SetupError
/// where files are wrong, the device has no such place, or no joint of the twin can be led.
config::Scenario moved_scenario(scenario::ScenarioOptions options);

}  // namespace hg::experiments

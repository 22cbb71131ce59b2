/// Scenario and recording of a run from the arguments of a command.
#pragma once

#include "apps/hapticgiant/run_command.h"
#include "hg/config/simulation/scenario.h"
#include "hg/recording/recorder.h"
#include "hg/scenario/names.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::apps {

using scenario::recorded_scenario;

/// Message when a recording is wanted but not available.
inline constexpr char kNoRecording[] = "recording   off (the program was built without Rust)\n";

/// Loads the scenario for a controller. With a remote device, simulation-only options are refused.
/// Throws SetupError.
config::Scenario make_scenario(const RunArguments& arguments);

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments);

}  // namespace hg::apps

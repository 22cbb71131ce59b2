/// Recordings of commands that play a scenario.
#pragma once

#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/recording/recorder.h"
#include "hg/scenario/options.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::apps {

using scenario::recorded_scenario;

/// What a recording of `scenario`, loaded with `options`, in `folder` says about its run.
recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const scenario::ScenarioOptions& options,
                                        const std::string& folder);

}  // namespace hg::apps

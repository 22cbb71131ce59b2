/// A scenario into a recording and back: a recording holds all files of its scenario, and the
/// options that it was loaded with.
#pragma once

#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/messages/run_names.h"
#include "hg/recording/recorder.h"
#include "hg/scenario/options.h"

namespace hg::scenario {

/// The scenario of a recording, from the files that it holds; the disk is not touched. Throws
/// SetupError.
config::Scenario recorded_scenario(const std::vector<recording::NamedText>& configuration);

/// Names of the joints and limits of a scenario, for messages.
messages::RunNames run_names(const config::Scenario& scenario);

/// What a recording of `scenario`, loaded with `options`, says about its run: all but its folder
/// and the version of the program.
recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const ScenarioOptions& options);

}  // namespace hg::scenario

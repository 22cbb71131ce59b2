/// Builds the parts of a run from arguments and files.
#pragma once

#include <vector>

#include "apps/hapticgiant/run_command.h"
#include "hg/config/simulation/scenario.h"
#include "hg/recording/problem_dumps.h"
#include "hg/recording/recorder.h"
#include "hg/scenario/names.h"
#include "hg/scenario/options.h"

namespace hg::apps {

/// Loads the scenario for a controller. With a remote device, simulation-only options are refused.
/// Throws SetupError.
config::Scenario make_scenario(const RunArguments& arguments);

/// The scenario of a recording, from the files that it holds; the disk is not touched. Throws
/// SetupError.
config::Scenario recorded_scenario(const std::vector<recording::NamedText>& configuration);

/// Problem dumps beside the recording of `recorder`, under its name; nullptr = no recording, which
/// may have been switched off.
recording::ProblemDumps problem_dumps(const config::Scenario& scenario,
                                      const RunArguments& arguments,
                                      const recording::Recorder* recorder);

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments);

}  // namespace hg::apps

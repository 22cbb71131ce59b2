/// From arguments and files to the parts of a run.
#pragma once

#include <memory>
#include <optional>

#include "apps/hapticgiant/problem_dumps.h"
#include "apps/hapticgiant/run_command.h"
#include "hg/config/scenario.h"
#include "hg/recording/recorder.h"
#include "hg/viewer_server/viewer_server.h"

namespace hg::apps {

/// The scenario with everything that the command line changes. Throws SetupError.
config::Scenario make_scenario(const ScenarioArguments& arguments);
/// The same, for a controller: also law and bounds. With a remote device, what only a simulation
/// looks at is refused.
config::Scenario make_scenario(const RunArguments& arguments);

/// Beside the recording of `recorder`, under its name; nullptr: there is none, it may have been
/// switched off.
ProblemDumps problem_dumps(const config::Scenario& scenario, const RunArguments& arguments,
                           const recording::Recorder* recorder);

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments);
viewer_server::Scene viewer_scene(const config::Scenario& scenario);

}  // namespace hg::apps

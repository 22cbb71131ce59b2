/// From arguments and files to the parts of a run.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "apps/hapticgiant/problem_dumps.h"
#include "apps/hapticgiant/run_command.h"
#include "hg/config/scenario.h"
#include "hg/evaluation/summary.h"
#include "hg/explanation/fault_figures.h"
#include "hg/recording/recorder.h"

namespace hg::apps {

/// The scenario with everything that the command line changes. Throws SetupError.
config::Scenario make_scenario(const ScenarioArguments& arguments);
/// The same, for a controller: also law and bounds. With a remote device, what only a simulation
/// looks at is refused.
config::Scenario make_scenario(const RunArguments& arguments);

/// The scenario of a recording, from the files that it holds; the disk is not touched. Throws
/// SetupError.
config::Scenario recorded_scenario(const std::vector<recording::NamedText>& configuration);

/// Beside the recording of `recorder`, under its name; nullptr: there is none, it may have been
/// switched off.
ProblemDumps problem_dumps(const config::Scenario& scenario, const RunArguments& arguments,
                           const recording::Recorder* recorder);

/// What the summary says of a run that its scenario tells: title, and the law as it really is, not
/// what was asked for.
evaluation::RunFacts facts_of_scenario(const config::Scenario& scenario);

/// What the parts of the device are called in messages.
explanation::Names part_names(const config::Scenario& scenario);

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments);

}  // namespace hg::apps

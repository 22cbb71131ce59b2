/// Builds the parts of a run from arguments and files.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "apps/hapticgiant/problem_dumps.h"
#include "apps/hapticgiant/run_command.h"
#include "hg/analysis/fault_figures.h"
#include "hg/analysis/summary.h"
#include "hg/config/scenario.h"
#include "hg/recording/recorder.h"

namespace hg::apps {

/// Loads the scenario and applies the command line. Throws SetupError.
config::Scenario make_scenario(const ScenarioArguments& arguments);
/// Loads the scenario for a controller: also applies law and bounds. With a remote device,
/// simulation-only options are refused.
config::Scenario make_scenario(const RunArguments& arguments);

/// The scenario of a recording, from the files that it holds; the disk is not touched. Throws
/// SetupError.
config::Scenario recorded_scenario(const std::vector<recording::NamedText>& configuration);

/// Problem dumps beside the recording of `recorder`, under its name; nullptr = no recording, which
/// may have been switched off.
ProblemDumps problem_dumps(const config::Scenario& scenario, const RunArguments& arguments,
                           const recording::Recorder* recorder);

/// Summary facts of a run given by its scenario: title, and the actual law, not the requested one.
analysis::RunFacts facts_of_scenario(const config::Scenario& scenario);

/// Names of the parts of the device for messages.
analysis::Names part_names(const config::Scenario& scenario);

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments);

}  // namespace hg::apps

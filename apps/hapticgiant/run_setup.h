/// From arguments and files to the parts of a run.
#pragma once

#include <memory>
#include <optional>

#include "apps/hapticgiant/run_command.h"
#include "hg/config/scenario.h"
#include "hg/cycle/cycle.h"
#include "hg/device/simulated_device.h"
#include "hg/recording/recorder.h"
#include "hg/viewer_server/viewer_server.h"

namespace hg::apps {

/// The scenario with everything that the command line changes. Throws SetupError.
config::Scenario make_scenario(const RunArguments& arguments);

/// A cycle and a simulated device that starts where the twin starts. Throws SetupError when the
/// device cannot reach that pose.
cycle::Cycle make_cycle(const config::Scenario& scenario);
device::SimulatedDevice make_simulated_device(const config::Scenario& scenario);

/// Seconds until everything planned has happened; 0 = nothing is planned.
double planned_duration_s(const config::Scenario& scenario);

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments);
viewer_server::Scene viewer_scene(const config::Scenario& scenario);

}  // namespace hg::apps

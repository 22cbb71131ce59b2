/// Changes that experiments make to a scenario.
#pragma once

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/free_twin.h"

namespace hg::experiments {

/// Replaces mass and damping of the scenario's free body; its moments of inertia and angular
/// damping stay. Throws SetupError when the twin is not a free body.
void set_free_twin(config::Scenario& scenario, const FreeTwin& twin);

/// Gives the scenario's free body the same moment of inertia about all axes, kg m^2; its mass
/// stays. Throws SetupError when the twin is not a free body.
void set_free_inertia(config::Scenario& scenario, double inertia);

/// Mass and damping of the scenario's free body. Throws SetupError when the twin is not one.
FreeTwin free_twin_of(const config::Scenario& scenario);

/// Makes the person play only `script`, from the scenario's own grasp on; the run ends with it.
void play_script(config::Scenario& scenario, const person::Script& script);

/// Removes the joint friction, from the true device and from the controller's model.
void take_friction(DeviceModel& device);

}  // namespace hg::experiments

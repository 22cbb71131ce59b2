/// What experiments change about a scenario.
#pragma once

#include "hg/config/scenario.h"
#include "hg/experiments/motion_analysis.h"

namespace hg::experiments {

/// Puts a body of that mass and damping in the place of the scenario's free body; its moments of
/// inertia and angular damping stay. Throws SetupError when the twin is not a free body.
void set_free_twin(config::Scenario& scenario, const FreeTwin& twin);

/// Gives the scenario's free body the same moment of inertia about all axes, kg m^2; its mass
/// stays. Throws SetupError when the twin is not a free body.
void set_free_inertia(config::Scenario& scenario, double inertia);

/// Of the scenario's free body. Throws SetupError when the twin is not one.
FreeTwin free_twin_of(const config::Scenario& scenario);

/// The person plays `script` and nothing else, from the scenario's own grasp on; with it the run
/// ends.
void play_script(config::Scenario& scenario, const user::Script& script);

/// Takes the friction of the joints away, in truth and in what the controller believes.
void take_friction(control::Config& control);

}  // namespace hg::experiments

/// Set-up data of a control cycle.
#pragma once

#include <vector>

#include "hg/controller/estimation/estimation_config.h"
#include "hg/controller/prepositioning/prepositioning_config.h"
#include "hg/controller/rendering/options.h"
#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/controller/safety/collision/collision_config.h"
#include "hg/controller/safety/compliance/compliance_config.h"
#include "hg/controller/safety/monitor_config.h"
#include "hg/controller/safety/passivity/passivity_config.h"
#include "hg/controller/safety/sanitiser_config.h"
#include "hg/controller/tracking/control_config.h"
#include "hg/signals/timed_load.h"

namespace hg::controller {

/// Set-up data.
struct CycleConfig {
  estimation::EstimationConfig estimation;
  prepositioning::PrepositioningConfig prepositioning;
  rendering::RenderingOptions rendering;
  tracking::ControlConfig control;
  safety::MonitorConfig monitor;
  safety::SanitiserConfig sanitiser;
  collision::CollisionConfig collision;
  passivity::PassivityConfig passivity;
  compliance::ComplianceConfig compliance;
  std::vector<surfaces::Surface> surfaces;  ///< Virtual surfaces in contact with the twin
  std::vector<SolverCap> solver_caps;       ///< Injected faults of the computer; empty = none
};

}  // namespace hg::controller

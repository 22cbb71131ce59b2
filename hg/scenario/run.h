/// A run of a scenario: the options that it gives to the runtime, and what is known of it
/// afterwards.
#pragma once

#include "hg/analysis/summary.h"
#include "hg/config/simulation/scenario.h"
#include "hg/runtime/runtime.h"

namespace hg::scenario {

/// Options of a run that follow from the scenario: rate, planned duration, all that happens at
/// given times, and how long a stop may take. Panels that reset keep the run alive after a fault.
runtime::RuntimeOptions run_options(const config::Scenario& scenario);

/// Facts of a run for its summary: the scenario's, the timing of the control thread, lost samples.
analysis::RunFacts facts_of_run(const config::Scenario& scenario,
                                const runtime::RuntimeOptions& options,
                                const runtime::RuntimeReport& report);

}  // namespace hg::scenario

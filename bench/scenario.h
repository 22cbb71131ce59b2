/// Scenarios as benchmarks play them.
#pragma once

#include <string>

#include "hg/config/simulation/scenario.h"

namespace hg::bench {

/// The scenario `name` (or file) with an ideal machine: solver and law are compared without the
/// effects of an elastic one. Throws SetupError, also for a scenario without a script.
config::Scenario bench_scenario(const std::string& name);

}  // namespace hg::bench

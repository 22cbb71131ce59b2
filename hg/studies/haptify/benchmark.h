/// Everything that `hapticgiant haptify` measures, in the order of its report.
#pragma once

#include <functional>
#include <string>

#include "hg/config/scenario.h"
#include "hg/studies/haptify/figures.h"

namespace hg::haptify {

/// Callback that reports the current measurement and how many of its runs are done; called by one
/// thread at a time.
using Told = std::function<void(const std::string& what, std::size_t done, std::size_t total)>;

/// Runs the benchmark. `scenario`: a hand that leads a free body (models/scenarios/walk.yaml). The
/// same scenario and options give the same figures. Throws SetupError when the twin is not a free
/// body.
Benchmark measure(const config::Scenario& scenario, const HaptifyOptions& options,
                  const Told& told);

}  // namespace hg::haptify

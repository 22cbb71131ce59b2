/// Design goals of the device, over seeds, heights of the handle and hands: Table III is for
/// the middle of the workspace, this for the worst case.
#pragma once

#include "hg/config/scenario.h"
#include "hg/studies/haptify/benchmark.h"
#include "hg/studies/haptify/figures.h"

namespace hg::haptify {

/// Figures with a goal each, in `beyond`; their values are all runs, of `options.repetitions` seeds
/// at three heights and, where a person holds the handle, in three hands. `scenario` and errors as
/// those of measure(); `light` is the same with the lightest body that the device can render: it is
/// used for the forces of free space and of a surface without friction.
Benchmark measure_goals(const config::Scenario& scenario, const config::Scenario& light,
                        const HaptifyOptions& options, const Told& told);

/// Table with one row per goal: median, least and largest of all runs, and how many are within.
Table goals_table(const Benchmark& goals);

}  // namespace hg::haptify

/// What the device is built to reach, over seeds, heights of the handle and hands: Table III says
/// how it is in the middle, this says how it is at its worst.
#pragma once

#include "hg/config/scenario.h"
#include "hg/haptify/benchmark.h"
#include "hg/haptify/figures.h"

namespace hg::haptify {

/// Figures with a goal each, in `beyond`; their values are all runs, of `options.repetitions` seeds
/// at three heights and, where a person holds the handle, in three hands. `scenario` and errors as
/// those of measure(); `light` is the same with a body that is as free as the device can show one:
/// the force of free space and of a surface without friction are its own.
Benchmark measure_goals(const config::Scenario& scenario, const config::Scenario& light,
                        const Options& options, const Told& told);

/// One row per goal: median, least and largest of all runs, and how many are within.
Table goals_table(const Benchmark& goals);

}  // namespace hg::haptify

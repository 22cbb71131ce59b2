/// Computation time of Cycle::step and of its stages, in scenarios.
#pragma once

#include <array>
#include <string>

#include "bench/times.h"
#include "hg/config/simulation/scenario.h"
#include "hg/core/stage_probe.h"

namespace hg::bench {

/// Times of rendering cycles; the fastest of several plays counts for each cycle and stage.
struct CycleTimes {
  std::string scenario;
  Times total;  ///< time of the whole cycle, in separate plays without stage timing
  std::array<Times, kStageCount> stages;
};

/// Plays the scenario 2 x `passes` times, up to `most` cycles that render.
CycleTimes measure_cycle(const std::string& name, const config::Scenario& scenario, int passes,
                         std::size_t most);

}  // namespace hg::bench

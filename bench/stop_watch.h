/// Measures the time of each stage of a control cycle.
#pragma once

#include <array>

#include "bench/player.h"
#include "bench/times.h"
#include "hg/core/index.h"
#include "hg/core/stage_probe.h"

namespace hg::bench {

/// Adds the time since the previous stage to each stage that ends; a stage may end several times.
class StopWatch {
 public:
  /// Runs the cycle begun by the player; the times are those of this cycle.
  void run(Player& player) noexcept {
    us_.fill(0.0);
    player.cycle().watch({.ended = lap, .listener = this});
    last_ = Clock::now();
    player.run();
    player.cycle().watch({});
  }

  double us(Stage stage) const noexcept { return us_[index(stage)]; }

 private:
  static void lap(void* listener, Stage stage) noexcept {
    auto& watch = *static_cast<StopWatch*>(listener);
    const Clock::time_point now = Clock::now();
    watch.us_[index(stage)] += std::chrono::duration<double, std::micro>(now - watch.last_).count();
    watch.last_ = now;
  }

  std::array<double, kStageCount> us_{};
  Clock::time_point last_;
};

}  // namespace hg::bench

#include "bench/cycle_table.h"

#include "bench/player.h"
#include "bench/stop_watch.h"

namespace hg::bench {
namespace {

template <typename Measure>
void play(const config::Scenario& scenario, std::size_t most, const Measure& measure) {
  Player player(scenario);
  std::size_t index = 0;
  bool has_more = true;
  while (has_more && index < most) {
    player.begin();
    measure(player, index);
    if (player.is_running()) ++index;
    has_more = player.end();
  }
}

}  // namespace

CycleTimes measure_cycle(const std::string& name, const config::Scenario& scenario, int passes,
                         std::size_t most) {
  CycleTimes times;
  times.scenario = name;
  for (int pass = 0; pass < passes; ++pass) {
    play(scenario, most, [&](Player& player, std::size_t index) {
      const Clock::time_point begin = Clock::now();
      player.run();
      const double us = microseconds_since(begin);
      if (player.is_running()) times.total.add(index, us);
    });
    play(scenario, most, [&](Player& player, std::size_t index) {
      StopWatch watch;
      watch.run(player);
      if (!player.is_running()) return;
      for (std::size_t i = 0; i < times.stages.size(); ++i) {
        times.stages[i].add(index, watch.us(static_cast<Stage>(i)));
      }
    });
  }
  return times;
}

}  // namespace hg::bench

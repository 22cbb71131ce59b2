#include "bench/cycle_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/player.h"
#include "bench/stop_watch.h"

namespace hg::bench {
namespace {

template <typename Measure>
void play(const config::Scenario& scenario, std::size_t most, const Measure& measure) {
  Player player(scenario);
  std::size_t index = 0;
  bool goes_on = true;
  while (goes_on && index < most) {
    player.begin();
    measure(player, index);
    if (player.is_running()) ++index;
    goes_on = player.end();
  }
}

constexpr const char* kLine = "{:<20} {:<17} {:>8} {:>8} {:>8} {:>8} {:>7}\n";

std::string line(const std::string& scenario, const std::string& stage, const Times& times,
                 double whole) {
  const analysis::Distribution d = times.distribution();
  return fmt::format(kLine, scenario, stage, fmt::format("{:.2f}", d.median), to_text(d.p99_9, 2),
                     fmt::format("{:.2f}", d.max), fmt::format("{:.2f}", times.mean()),
                     fmt::format("{:.0f} %", 100.0 * times.mean() / whole));
}

nlohmann::ordered_json row_of(const CycleTimes& times, const char* stage, const Times& part) {
  nlohmann::ordered_json row = {
      {"scenario", times.scenario}, {"stage", stage}, {"cycles", part.count()}};
  add_to(row, part.distribution());
  row["mean_us"] = part.mean();
  return row;
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

std::string cycle_header() {
  return fmt::format(kLine, "scenario", "stage", "median", "99.9 %", "max", "mean", "share");
}

std::string to_text(const CycleTimes& times) {
  double whole = 0.0;
  for (const Times& stage : times.stages) whole += stage.mean();
  std::string text =
      fmt::format("{}", line(times.scenario, "Cycle::step", times.total, times.total.mean()));
  for (int i = 0; i < kStageCount; ++i) {
    text += line("", to_string(static_cast<Stage>(i)), times.stages[static_cast<std::size_t>(i)],
                 whole);
  }
  return text;
}

nlohmann::ordered_json to_json(const CycleTimes& times) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  rows.push_back(row_of(times, "total", times.total));
  for (int i = 0; i < kStageCount; ++i) {
    rows.push_back(
        row_of(times, to_string(static_cast<Stage>(i)), times.stages[static_cast<std::size_t>(i)]));
  }
  return rows;
}

}  // namespace hg::bench

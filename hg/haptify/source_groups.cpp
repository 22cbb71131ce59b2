// What force and vibration of free space come from: imperfections taken away one by one.

#include <fmt/format.h>

#include <algorithm>

#include "hg/experiments/free_space.h"
#include "hg/haptify/free_space.h"
#include "hg/haptify/groups.h"

namespace hg::haptify {
namespace {

struct Source {
  std::string name;
  FreeSpace measured;
};

// Of the figure, where it misses its goal: what helps it most.
void explain(const std::string& id, const std::vector<Source>& sources, double FreeSpace::*field,
             bool is_better_high, Benchmark& out) {
  const auto figure = std::ranges::find(out.table, id, &Figure::id);
  if (figure == out.table.end() || sources.size() < 2) return;
  const auto best =
      std::ranges::max_element(sources.begin() + 1, sources.end(), {}, [&](const Source& source) {
        return is_better_high ? source.measured.*field : -(source.measured.*field);
      });
  figure->why += fmt::format(
      "On one way of {:.0f} s: {:.3g} {} as it is; of the imperfections taken away one by one "
      "\"{}\" changes most, to {:.3g} {} (table \"What vibration comes from\").",
      FreeSpaceConfig{}.duration_s, sources.front().measured.*field, figure->unit, best->name,
      best->measured.*field, figure->unit);
}

}  // namespace

void add_sources(const Group& group) {
  FreeSpaceConfig config;
  if (group.options.is_quick) config.duration_s = 4.0;
  std::vector<experiments::FreeSpaceVariant> variants = experiments::free_space_variants();
  std::erase_if(variants, [&](const experiments::FreeSpaceVariant& variant) {
    return &variant != &variants.front() && !variant.takes_away;
  });
  if (group.options.is_quick) variants.resize(2);
  const auto sources =
      group.measure_all("sources of vibration", variants.size(), [&](std::size_t i) {
        config::Scenario changed = group.scenario;
        if (variants[i].change) variants[i].change(changed);
        return Source{variants[i].name, measure_free_space(changed, config, group.seed(0))};
      });
  Table table = {.id = "vibration_sources",
                 .title = "What vibration comes from",
                 .note =
                     "Free space with one imperfection of the simulated machine or person "
                     "taken away at a time, one way each.",
                 .columns = {"", "vibration m/s^2", "centroid Hz", "force N", "added force N"}};
  for (const Source& source : sources) {
    const FreeSpace& it = source.measured;
    group.add_failure("sources of vibration, " + source.name, it.failure);
    table.rows.push_back({source.name, fmt::format("{:.4f}", it.vibration_rms),
                          fmt::format("{:.1f}", it.centroid_Hz), fmt::format("{:.3f}", it.force),
                          fmt::format("{:.3f}", it.extra)});
  }
  explain("free_space_vibration", sources, &FreeSpace::vibration_rms, false, group.out);
  explain("free_space_centroid", sources, &FreeSpace::centroid_Hz, true, group.out);
  group.out.tables.push_back(table);
}

}  // namespace hg::haptify

// What force and vibration of free space come from: imperfections taken away one by one.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <span>

#include "hg/studies/haptify/free_space_variants.h"
#include "hg/studies/haptify/groups.h"

namespace hg::haptify {
namespace {

struct Source {
  std::string name;
  FreeSpace measured;
};

// Every joint of the least stiffness is so many times as stiff; the controller knows it.
void stiffen_softest(double factor, tracking::ControlConfig& control) {
  double softest = kInfinity;
  for (const ActuatorModel& it : control.actuators) softest = std::min(softest, it.stiffness);
  for (ActuatorModel& it : control.actuators) {
    if (it.stiffness == softest) it.stiffness *= factor;
  }
}

// Variants of the transmission between a source and the handle.
std::vector<FreeSpaceVariant> changed_ways() {
  using config::Scenario;
  return {{.name = "measured wrench not low-passed",
           .change = [](Scenario& s) { s.device.estimation.wrench.low_pass_Hz = 0.0; }},
          {.name = "softest joints four times as stiff",
           .change = [](Scenario& s) { stiffen_softest(4.0, s.device.control); }}};
}

// "0.018 m/s^2 at 69.3 Hz"
std::string told(const Source& source) {
  return fmt::format("{:.4f} m/s^2 at {:.1f} Hz", source.measured.vibration_rms,
                     source.measured.centroid_Hz);
}

// Why the spectrum ends where it does. `sources`: as shipped, with sources taken away, and then as
// many with the way changed as `ways` says.
std::string why_centroid(const std::vector<Source>& sources, std::size_t ways, double seconds) {
  const Source& shipped = sources.front();
  const std::span without(sources.begin() + 1, sources.end() - static_cast<std::ptrdiff_t>(ways));
  const auto centroid = [](const Source& source) { return source.measured.centroid_Hz; };
  const auto [low, high] = std::ranges::minmax(without | std::views::transform(centroid));
  const auto quietest =
      std::ranges::min(without, {}, [](const Source& it) { return it.measured.vibration_rms; });
  const auto& bands = shipped.measured.band_rms;
  std::string text = fmt::format(
      "The way to the handle makes it, not a source. On one way of {:.0f} s vibration is {}; with "
      "one imperfection taken away at a time the centroid stays between {:.1f} and {:.1f} Hz, "
      "though \"{}\" leaves only {:.4f} m/s^2. Above 100 Hz nearly nothing arrives ({:.4f} m/s^2 "
      "of {:.4f}): the springs of the joints isolate the handle above their resonances, and what "
      "noise of the wrench asks for is low-passed before. ",
      seconds, told(shipped), low, high, quietest.name, quietest.measured.vibration_rms,
      std::hypot(bands[2], bands[3]), shipped.measured.vibration_rms);
  for (const Source& way : std::span(sources).last(ways)) {
    text += fmt::format("With \"{}\" it is {}. ", way.name, told(way));
  }
  return text +
         "What shakes a real handle there (teeth, drives, bending links) is not simulated; a "
         "higher figure means another machine or more vibration, not a better feel.";
}

}  // namespace

Curve vibration_curve(const std::string& id, const std::string& name, const FreeSpace& measured) {
  Curve curve = {.id = id, .name = name, .x_label = "frequency in Hz"};
  std::vector<double> magnitude;
  for (std::size_t i = 0; i < measured.spectrum.magnitude.size(); ++i) {
    const double frequency = static_cast<double>(i) * measured.spectrum.step_Hz;
    if (frequency < kVibrationBand || frequency > kBandEdges.back()) continue;
    curve.x.push_back(frequency);
    magnitude.push_back(measured.spectrum.magnitude[i]);
  }
  curve.y["m/s^2/sqrt(Hz)"] = std::move(magnitude);
  return curve;
}

void add_sources(const Group& group) {
  FreeSpaceConfig config;
  if (group.options.is_quick) config.duration_s = 4.0;
  std::vector<FreeSpaceVariant> variants = free_space_variants();
  std::erase_if(variants, [&](const FreeSpaceVariant& variant) {
    return &variant != &variants.front() && !variant.takes_away;
  });
  if (group.options.is_quick) variants.resize(2);
  const std::vector<FreeSpaceVariant> ways = changed_ways();
  variants.insert(variants.end(), ways.begin(), ways.end());
  const auto sources =
      group.measure_all("sources of vibration", variants.size(), [&](std::size_t i) {
        return Source{variants[i].name,
                      measure_variant(group.scenario, variants[i], config, group.seed(0))};
      });
  Table table = {.id = "vibration_sources",
                 .title = "What vibration comes from",
                 .note =
                     "Free space with one imperfection of the simulated machine or person "
                     "taken away at a time, one way each; the last rows change what lies between a "
                     "source and the handle. Bands in Hz, rms in mm/s^2.",
                 .columns = {"", "vibration m/s^2", "centroid Hz", "force N", "added force N"}};
  for (std::size_t i = 0; i + 1 < kBandEdges.size(); ++i) {
    table.columns.push_back(fmt::format("{:g} .. {:g}", kBandEdges[i], kBandEdges[i + 1]));
  }
  bool has_all = true;
  for (const Source& source : sources) {
    const FreeSpace& it = source.measured;
    has_all = group.has_worked("sources of vibration, " + source.name, it.failure) && has_all;
    if (!it.failure.empty()) continue;
    table.rows.push_back({source.name, fmt::format("{:.4f}", it.vibration_rms),
                          fmt::format("{:.1f}", it.centroid_Hz), fmt::format("{:.3f}", it.force),
                          fmt::format("{:.3f}", it.extra)});
    group.out.curves.push_back(vibration_curve("vibration_sources", source.name, it));
    for (const double rms : it.band_rms) {
      table.rows.back().push_back(fmt::format("{:.2f}", 1e3 * rms));
    }
  }
  const auto figure = std::ranges::find(group.out.table, "free_space_centroid", &Figure::id);
  const bool is_telling = has_all && !group.options.is_quick;  // a quick run measures too few
  if (figure != group.out.table.end() && is_telling) {
    figure->why = why_centroid(sources, ways.size(), config.duration_s);
  }
  group.out.tables.push_back(table);
}

}  // namespace hg::haptify

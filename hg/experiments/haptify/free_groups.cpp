// Workspace, free space and strokes: what needs no virtual surface and no frequency.

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/dynamics.h"
#include "hg/experiments/haptify/free_space_variants.h"
#include "hg/experiments/haptify/groups.h"
#include "hg/experiments/haptify/shape.h"

namespace hg::haptify {
namespace {

using nlohmann::json;

// Every joint of the least stiffness is so many times as stiff; the controller knows it.
void stiffen_softest(double factor, DeviceModel& device) {
  double softest = kInfinity;
  for (const ActuatorModel& it : device.actuators) softest = std::min(softest, it.stiffness);
  for (ActuatorModel& it : device.actuators) {
    if (it.stiffness == softest) it.stiffness *= factor;
  }
}

// Variants of the transmission between a source and the handle.
std::vector<FreeSpaceVariant> changed_ways() {
  using config::Scenario;
  return {{.name = "measured wrench not low-passed",
           .change = [](Scenario& s) { s.device.estimation.wrench.low_pass_Hz = 0.0; }},
          {.name = "softest joints four times as stiff",
           .change = [](Scenario& s) { stiffen_softest(4.0, s.device.model); },
           .needs = Needs::kElasticJoints}};
}

// Why strokes do not fit at the place.
std::string no_strokes(const experiments::Place& place, const DynamicsConfig& config, int axis) {
  if (axis < 3) return experiments::no_room(place, Eigen::Vector3d::Unit(axis), config.stroke);
  if (config.angle <= 2.0 * place.turn) return "";
  return fmt::format("{}the handle can turn by {:g} rad only", experiments::kNotPossible,
                     2.0 * place.turn);
}

std::vector<double> numbers(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

}  // namespace

void add_workspace(const Group& group) {
  const ShapeConfig config = {.postures = group.options.is_quick ? 4'000 : 60'000};
  const config::DeviceConfig& device = group.scenario.device;
  std::vector<Play> plays;
  for (const std::uint64_t seed : group.seeds()) {
    plays.push_back({{{"seed", seed}}, [&device, &config, seed, first = group.options.seed] {
                       const workspace::HandleWorkspace shape = measure_shape(device, config, seed);
                       json run = {{"volume", shape.volume},
                                   {"nominal_volume", shape.share_nominal * shape.box_volume},
                                   {"has_box", shape.has_box},
                                   {"box_volume", shape.box_volume},
                                   {"lower", numbers(shape.bounds.min())},
                                   {"upper", numbers(shape.bounds.max())}};
                       if (seed != first) return run;
                       run["unreached"] = unreached_sides(device, shape, config, seed);
                       run["views"] = workspace_views(device, config, seed);
                       return run;
                     }});
  }
  group.add("workspace", json::object(), plays);
}

void add_free_space(const Group& group) {
  FreeSpaceConfig config = free_space_at(group.place);
  if (group.options.is_quick) config.duration_s = 6.0;
  const config::Scenario light = with_body(group.scenario, kLightBody);
  std::vector<Play> plays;
  for (const config::Scenario* scenario : {&group.scenario, &light}) {
    const json body = as_json(experiments::free_twin_of(*scenario));
    for (const std::uint64_t seed : group.seeds()) {
      plays.push_back({{{"body", body}, {"seed", seed}}, [&config, scenario, seed] {
                         return json(measure_free_space(*scenario, config, seed));
                       }});
    }
  }
  group.add("free space",
            {{"duration_s", config.duration_s},
             {"body", as_json(experiments::free_twin_of(group.scenario))},
             {"light_body", as_json(experiments::free_twin_of(light))},
             {"accelerometer_noise", group.scenario.device.simulation.sensors.accelerometer.noise}},
            plays);
}

void add_sources(const Group& group) {
  FreeSpaceConfig config = free_space_at(group.place);
  if (group.options.is_quick) config.duration_s = 4.0;
  std::vector<FreeSpaceVariant> variants = free_space_variants();
  std::erase_if(variants, [&](const FreeSpaceVariant& variant) {
    return &variant != &variants.front() && !variant.takes_away;
  });
  if (group.options.is_quick) variants.resize(2);
  const std::size_t sources = variants.size();
  for (FreeSpaceVariant& way : changed_ways()) variants.push_back(std::move(way));
  std::vector<Play> plays;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    plays.push_back(
        {{{"name", variants[i].name}, {"changes_way", i >= sources}}, [&, i] {
           const std::string why = no_variant(group.scenario.device, variants[i]);
           if (!why.empty()) return impossible(why);
           return json(measure_variant(group.scenario, variants[i], config, group.options.seed));
         }});
  }
  group.add("sources of vibration", {{"duration_s", config.duration_s}, {"band_edges", kBandEdges}},
            plays);
}

void add_dynamics(const Group& group) {
  DynamicsConfig config = placed(DynamicsConfig(), group.place);
  if (group.options.is_quick) {
    config.duration_s = {0.8};
    config.strokes = 2;
  }
  std::vector<Play> plays;
  for (int axis = 0; axis < kStrokeAxes; ++axis) {
    for (const std::uint64_t seed : group.seeds()) {
      plays.push_back({{{"axis", axis}, {"seed", seed}}, [&group, &config, axis, seed] {
                         const std::string why = no_strokes(group.place, config, axis);
                         if (!why.empty()) return impossible(why);
                         return json(measure_dynamics(group.scenario, config, axis, seed));
                       }});
    }
  }
  group.add("strokes", json::object(), plays);
}

}  // namespace hg::haptify

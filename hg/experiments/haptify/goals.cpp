// Design goals of the device, over seeds, heights of the handle and hands.

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/groups.h"
#include "hg/experiments/haptify/response.h"
#include "hg/experiments/haptify/surface.h"
#include "hg/experiments/player.h"
#include "hg/experiments/stability_map.h"

namespace hg::haptify {
namespace {

using nlohmann::json;

// Conditions of a run.
struct Condition {
  std::uint64_t seed = 0;
  double height = 0.0;  // height of the handle, m in B
  std::string hand;
  person::HandPreset preset = person::HandPreset::kNormal;
};

// Every seed at every height, in every hand.
std::vector<Condition> conditions(
    const Group& group, const std::vector<std::pair<std::string, person::HandPreset>>& hands) {
  std::vector<Condition> all;
  for (const std::uint64_t seed : group.seeds()) {
    const experiments::Place& place = group.place;
    for (const double height : {place.lower.z(), place.middle.z(), place.upper.z()}) {
      if (group.options.is_quick && height != place.middle.z()) continue;
      for (const auto& [name, preset] : hands) all.push_back({seed, height, name, preset});
    }
  }
  return all;
}

std::vector<Condition> in_all_hands(const Group& group) {
  return conditions(group, hands(group.options.is_quick));
}

// For measurements that fix the hand or have none.
std::vector<Condition> in_normal_hand(const Group& group) {
  return conditions(group, {{"normal", person::HandPreset::kNormal}});
}
std::vector<Condition> in_stiff_hand(const Group& group) {
  return conditions(group, {{"stiff", person::HandPreset::kStiff}});
}

config::Scenario under(const Condition& condition, config::Scenario scenario) {
  experiments::set_seed(scenario, condition.seed);
  scenario.script.hand = person::hand(condition.preset);
  scenario.twin.model.q_start[2] = condition.height;
  return scenario;
}

ResponseConfig response_at(const Group& group, double height, double force) {
  ResponseConfig config = placed(ResponseConfig(), group.place);
  config.frequency_Hz = {3, 5, 8, 12, 20, 30};
  config.least_s = 1.0;
  config.force = force;
  config.position.z() = height;
  return config;
}

SurfaceConfig surface_at_height(const Group& group, double height) {
  SurfaceConfig config = surface_at(group.place);
  config.position.z() = height;
  return config;
}

// Plays each of `values`, for example axes, under each of the conditions.
void add(const Group& group, const std::string& name, const std::vector<Condition>& all,
         const std::vector<double>& values,
         const std::function<json(const Condition&, const config::Scenario&, double)>& measure) {
  std::vector<Play> plays;
  for (const Condition& at : all) {
    for (const double value : values) {
      plays.push_back(
          {{{"seed", at.seed}, {"height", at.height}, {"hand", at.hand}, {"value", value}},
           [&group, &measure, &at, value] {
             return measure(at, under(at, group.scenario), value);
           }});
    }
  }
  group.add(name, {{"body", as_json(experiments::free_twin_of(group.scenario))}}, plays);
}

const std::vector<double> kEachAxis = {0, 1, 2};
const std::vector<double> kOnce = {0};

void add_transparency(const Group& group, double force) {
  add(group, fmt::format("transparency, {:g} N", force), in_normal_hand(group), kEachAxis,
      [&group, force](const Condition& at, const config::Scenario& scenario, double axis) {
        const Response found = measure_response(scenario, response_at(group, at.height, force),
                                                static_cast<int>(axis), at.seed);
        return json{{"transparency_Hz", transparency_Hz(found)}, {"failure", found.failure}};
      });
}

void add_latencies(const Group& group) {
  add(group, "latency", in_normal_hand(group), kEachAxis,
      [&group](const Condition& at, const config::Scenario& scenario, double axis) {
        return json(measure_latency(scenario, response_at(group, at.height, 10.0),
                                    static_cast<int>(axis), at.seed));
      });
}

// Strokes at one height.
void add_strokes(const Group& group, const std::string& name) {
  add(group, name, in_all_hands(group), kOnce,
      [&group](const Condition& at, const config::Scenario& scenario, double) {
        FreeSpaceConfig config = free_space_at(group.place);
        config.duration_s = group.options.is_quick ? 6.0 : 22.0;
        config.lower.z() = config.upper.z() = at.height;
        return json(measure_free_space(scenario, config, at.seed));
      });
}

void add_light_body(const Group& group, const std::vector<Condition>& all, double mass) {
  constexpr double kDamping = 4.0;  // Ns/m
  add(group, fmt::format("kick, {:g} kg", mass), all, kOnce,
      [&group, mass](const Condition& at, const config::Scenario& scenario, double) {
        experiments::StabilityConfig config = placed(experiments::StabilityConfig(), group.place);
        config.position.z() = at.height;
        const auto found = kick(scenario, config, person::hand(at.preset), mass, kDamping);
        return json{{"last_speed", found.last_speed}};
      });
}

void add_wall(const Group& group, double mass) {
  constexpr double kStiffness = 20e3, kWallDamping = 20.0, kDamping = 4.0;  // N/m, Ns/m, Ns/m
  add(group, fmt::format("plane of 20 kN/m, {:g} kg", mass), in_all_hands(group), kOnce,
      [&group, mass](const Condition& at, const config::Scenario& scenario, double) {
        SurfaceConfig config = surface_at_height(group, at.height);
        config.knock_hand = at.preset;
        const Knock found = knock(with_body(scenario, {.mass = mass, .damping = kDamping}), config,
                                  kStiffness, kWallDamping);
        return json{{"verdict", to_string(found.verdict)}, {"failure", found.failure}};
      });
}

void add_slides(const Group& group) {
  add(group, "frictionless surface", in_all_hands(group), kOnce,
      [&group](const Condition& at, const config::Scenario& scenario, double) {
        SurfaceConfig config = surface_at_height(group, at.height);
        const std::string why =
            experiments::no_room(group.place, Eigen::Vector3d::UnitX(), config.stroke);
        if (!why.empty()) return impossible(why);
        config.strokes = group.options.is_quick ? 1 : 2;
        return json(measure_slide(scenario, config, at.seed));
      });
}

void add_presses(const Group& group) {
  add(group, "stiffness", in_stiff_hand(group), {1000.0, 2000.0, 4000.0},  // N/m
      [&group](const Condition& at, const config::Scenario& scenario, double stiffness) {
        SurfaceConfig config = surface_at_height(group, at.height);
        if (group.options.is_quick) config.press_s = 1.5;
        return json(measure_press(scenario, config, stiffness, at.seed));
      });
}

}  // namespace

Benchmark measure_goals(const config::Scenario& scenario, const config::Scenario& light,
                        const HaptifyOptions& options, experiments::Runs& runs) {
  const experiments::Place place = experiments::place_of(scenario.device);
  const config::Scenario held = experiments::at_place(scenario, place);
  const config::Scenario light_held = experiments::at_place(light, place);
  Benchmark result = {.device = scenario.device.name, .place = experiments::to_text(place)};
  const Group group = {held, options, runs, result, place};
  const Group with_light_body = {light_held, options, runs, result, place};
  add_transparency(group, 10.0);
  add_transparency(group, 40.0);
  add_latencies(group);
  add_strokes(group, "free space");
  add_light_body(group, in_normal_hand(group), 0.3);
  add_light_body(group, in_stiff_hand(group), 0.4);
  add_wall(group, 6.0);
  add_wall(group, 3.0);
  add_presses(group);
  add_strokes(with_light_body, "free space, light body");
  add_slides(with_light_body);
  return result;
}

}  // namespace hg::haptify

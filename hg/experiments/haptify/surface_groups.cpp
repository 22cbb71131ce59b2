// Frictionless surface, stiffness, peak force, Z-width and impacts.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/core/error.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/groups.h"
#include "hg/experiments/haptify/impact.h"
#include "hg/experiments/haptify/surface.h"

namespace hg::haptify {
namespace {

using nlohmann::json;
using Values = std::vector<double>;

// without the delays of the wrench and of what it is compensated with
config::Scenario prompt(config::Scenario scenario) {
  scenario.device.simulation.sensors.wrench.filter = {.average = 0.0, .delay = 0.0};
  scenario.device.simulation.sensors.imu_filter = {.average = 0.0, .delay = 0.0};
  scenario.device.estimation.wrench.low_pass_Hz = 0.0;
  return scenario;
}

// Why the strokes along x and y of B do not fit at the place.
std::string no_slide(const experiments::Place& place, const SurfaceConfig& config) {
  const std::string along_x = experiments::no_room(place, Eigen::Vector3d::UnitX(), config.stroke);
  if (!along_x.empty()) return along_x;
  return experiments::no_room(place, Eigen::Vector3d::UnitY(), config.stroke);
}

}  // namespace

void add_sliding(const Group& group) {
  SurfaceConfig config = surface_at(group.place);
  if (group.options.is_quick) config.strokes = 1;
  SurfaceConfig slow = config;
  slow.stroke_s *= 2.0;
  const config::Scenario light = with_body(group.scenario, kLightBody);
  std::vector<Play> plays;
  const auto slide = [&](const char* variant, const config::Scenario& scenario,
                         const SurfaceConfig& strokes) {
    for (const std::uint64_t seed : group.seeds()) {
      plays.push_back({{{"variant", variant}, {"seed", seed}}, [&, seed] {
                         const std::string why = no_slide(group.place, strokes);
                         if (!why.empty()) return impossible(why);
                         return json(measure_slide(scenario, strokes, seed));
                       }});
    }
  };
  slide("", group.scenario, config);
  slide("lighter body", light, config);
  slide("slower strokes", group.scenario, slow);
  group.add("frictionless surface",
            {{"stiffness", config.slide_stiffness},
             {"stroke", config.stroke},
             {"stroke_s", config.stroke_s},
             {"slow_stroke_s", slow.stroke_s},
             {"light_body", as_json(kLightBody)}},
            plays);
}

void add_stiffness(const Group& group) {
  const Values stiffness = group.options.is_quick ? Values{2000} : Values{1000, 2000, 4000};
  SurfaceConfig config = surface_at(group.place);
  if (group.options.is_quick) config.press_s = 1.5;
  std::vector<Play> plays;
  for (const double k : stiffness) {
    for (const std::uint64_t seed : group.seeds()) {
      plays.push_back({{{"stiffness", k}, {"seed", seed}}, [&group, &config, k, seed] {
                         return json(measure_press(group.scenario, config, k, seed));
                       }});
    }
  }
  group.add("stiffness", {{"stiffness", stiffness}, {"force", config.press_force}}, plays);
}

void add_peak(const Group& group) {
  SurfaceConfig config = surface_at(group.place);
  if (group.options.is_quick) config.peak_s = 3.0;
  std::vector<Play> plays;
  for (const std::uint64_t seed : group.seeds()) {
    plays.push_back({{{"seed", seed}}, [&group, &config, seed] {
                       return json(measure_peak(group.scenario, config, seed));
                     }});
  }
  group.add("peak force",
            {{"stiffness", config.peak_stiffness},
             {"tolerance", config.peak_tolerance},
             {"force", config.peak_force},
             {"force_max", group.scenario.device.monitor.force_max}},
            plays);
}

void add_z_width(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values stiffness =
      is_quick ? Values{1000, 8000} : Values{1000, 4000, 8000, 16000, 32000, 50000};
  const Values damping = is_quick ? Values{0} : Values{0, 20, 100, 400};
  const experiments::FreeTwin shipped = experiments::free_twin_of(group.scenario);
  std::vector<std::pair<experiments::FreeTwin, bool>> bodies = {{shipped, false},
                                                                {kLightBody, false}};
  if (!is_quick) bodies.emplace_back(kLightBody, true);
  const SurfaceConfig config = surface_at(group.place);
  std::vector<Play> plays;
  for (const auto& [body, is_prompt] : bodies) {
    for (const double k : stiffness) {
      for (const double d : damping) {
        plays.push_back(
            {{{"body", as_json(body)}, {"is_prompt", is_prompt}, {"stiffness", k}, {"damping", d}},
             [&group, &config, body = body, is_prompt = is_prompt, k, d] {
               const config::Scenario scenario = with_body(group.scenario, body);
               const Knock found = knock(is_prompt ? prompt(scenario) : scenario, config, k, d);
               return json{{"verdict", to_string(found.verdict)}, {"failure", found.failure}};
             }});
      }
    }
  }
  group.add("Z-width",
            {{"stiffness", stiffness},
             {"damping", damping},
             {"largest_stiffness", surfaces::kStiffness.ub}},
            plays);
}

namespace {

// A body in a hand that runs into walls with a speed.
struct Thrown {
  std::string hand;
  double mass = 0.0, speed = 0.0;
  config::Scenario scenario;
};

std::vector<Thrown> thrown(const config::Scenario& scenario, bool is_quick) {
  const Values speeds = is_quick ? Values{0.2, 0.83} : Values{0.2, 0.5, 0.83, 1.33};
  const Values masses = is_quick ? Values{0.5, 6} : Values{0.5, 3, 6, 20};
  const double damping = experiments::free_twin_of(scenario).damping;
  std::vector<Thrown> all;
  for (const auto& [hand, preset] : hands(is_quick)) {
    for (const double mass : masses) {
      for (const double speed : speeds) {
        all.push_back({hand, mass, speed, with_body(scenario, {mass, damping})});
        all.back().scenario.script.hand = person::hand(preset);
      }
    }
  }
  return all;
}

// How a body gets its speed: where the wall stands, and how long the goal moves.
struct RunUp {
  ImpactConfig config;
  double way_s = 0.0;
  std::string why_not;  // why it is not possible; empty = it is
};

RunUp find_run_up(const experiments::Place& place, const config::Scenario& scenario, double speed) {
  RunUp result;
  ImpactConfig& config = result.config;
  if (place.is_found) {
    const ImpactWay way = way_of_impact(scenario, config, speed);
    result.why_not = experiments::no_room(place, Eigen::Vector3d::UnitY(), way.run_up + way.behind);
    config.position = place.middle + 0.5 * (way.run_up - way.behind) * Eigen::Vector3d::UnitY();
  }
  if (!result.why_not.empty()) return result;
  try {
    result.way_s = find_way(scenario, config, speed);
  } catch (const SetupError& error) {
    result.why_not = std::string(experiments::kNotPossible) + error.what();
  }
  return result;
}

}  // namespace

void add_impacts(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values stiffness = is_quick ? Values{2e3, 5e4} : Values{2e3, 1e4, 2e4, 5e4};
  const std::vector<Thrown> bodies = thrown(group.scenario, is_quick);
  std::vector<std::optional<RunUp>> run_ups(bodies.size());  // found when first needed
  std::vector<Play> plays;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Thrown& body = bodies[i];
    for (const double k : stiffness) {
      plays.push_back({{{"hand", body.hand},
                        {"mass", body.mass},
                        {"wanted_speed", body.speed},
                        {"stiffness", k}},
                       [&, i, k] {
                         if (!run_ups[i]) {
                           run_ups[i] =
                               find_run_up(group.place, bodies[i].scenario, bodies[i].speed);
                         }
                         const RunUp& run_up = *run_ups[i];
                         if (!run_up.why_not.empty()) return impossible(run_up.why_not);
                         const Impact found =
                             measure_impact(bodies[i].scenario, run_up.config, k, bodies[i].speed,
                                            run_up.way_s, group.options.seed);
                         const bool is_slow = found.failure == kTooSlow && group.place.is_found;
                         if (is_slow) return impossible(experiments::kNotPossible + found.failure);
                         json run = found;
                         run["allowed"] = found.allowed();
                         return run;
                       }});
    }
  }
  group.add("impacts", {{"deepest", kDeepestImpact}, {"rest_speed", ImpactConfig().rest_speed}},
            plays, stiffness.size());
}

}  // namespace hg::haptify

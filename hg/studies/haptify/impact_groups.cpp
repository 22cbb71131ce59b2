// Impacts on walls: speeds, stiffnesses, bodies and hands.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/studies/changes.h"
#include "hg/studies/haptify/groups.h"
#include "hg/studies/haptify/impact.h"

namespace hg::haptify {
namespace {

using Values = std::vector<double>;
using Hands = std::vector<std::pair<std::string, person::HandPreset>>;

// A body in a hand that runs into walls with a speed.
struct Thrown {
  std::string name;  // "normal hand, 6 kg, 0.5 m/s"
  config::Scenario scenario;
  std::string hand;
  double mass = 0.0, speed = 0.0;
};

std::vector<Thrown> thrown(const config::Scenario& scenario, bool is_quick) {
  const Values speeds = is_quick ? Values{0.2, 0.83} : Values{0.2, 0.5, 0.83, 1.33};
  const Values masses = is_quick ? Values{0.5, 6} : Values{0.5, 3, 6, 20};
  Hands hands = {{"normal", person::HandPreset::kNormal}};
  if (!is_quick) {
    hands.insert(hands.begin(), {"relaxed", person::HandPreset::kRelaxed});
    hands.emplace_back("stiff", person::HandPreset::kStiff);
  }
  const double damping = studies::free_twin_of(scenario).damping;
  std::vector<Thrown> all;
  for (const auto& [hand, preset] : hands) {
    for (const double mass : masses) {
      for (const double speed : speeds) {
        Thrown one = {.name = fmt::format("{} hand, {:g} kg, {:g} m/s", hand, mass, speed),
                      .scenario = scenario,
                      .hand = hand,
                      .mass = mass,
                      .speed = speed};
        studies::set_free_twin(one.scenario, {.mass = mass, .damping = damping});
        one.scenario.script.hand = person::hand(preset);
        all.push_back(std::move(one));
      }
    }
  }
  return all;
}

// bounds missed by an impact
std::string missed(const Impact& impact) {
  std::string text;
  const auto add = [&](bool is_met, const char* what) {
    if (!is_met) text += (text.empty() ? "" : ", ") + std::string(what);
  };
  add(impact.end.empty(), impact.end.c_str());
  add(impact.depth <= impact.allowed(), "depth");
  add(impact.rebound <= kMostRebound, "rebound");
  add(impact.rest_s <= kLatestRest, "rest");
  add(impact.energy_out <= impact.energy_in, "energy");
  return text;
}

std::vector<std::string> row_of(const Thrown& body, double stiffness, const Impact& impact) {
  const auto mm = [](double length) { return fmt::format("{:.1f}", 1e3 * length); };
  return {body.hand,
          fmt::format("{:g}", body.mass),
          fmt::format("{:g}", stiffness),
          fmt::format("{:.2f}", impact.speed),
          mm(impact.depth),
          fmt::format("{:.1f}", impact.braking),
          mm(impact.bound),
          mm(impact.onset),
          mm(impact.spring),
          fmt::format("{:.2f}", impact.depth / impact.bound),
          fmt::format("{:.2f}", impact.depth / impact.allowed()),
          fmt::format("{:.2f}", impact.rebound),
          std::isinf(impact.rest_s) ? "never" : fmt::format("{:.2f}", impact.rest_s),
          fmt::format("{:.0f}", 100.0 * impact.energy_out / impact.energy_in),
          fmt::format("{:.0f}", impact.peak_force),
          fmt::format("{:.0f}", impact.felt_force),
          missed(impact)};
}

Table table_for(const ImpactConfig& config) {
  return {.id = "impacts",
          .title = "Impacts on a wall",
          .note = fmt::format(
              "A hand that aims behind an upright wall runs into it with a body; the wall says no "
              "damping. Speed just before it; deepest point of the handle in the first contact; a, "
              "with which the motors can brake it there against the mean force of the hand, and "
              "v^2 / (2 a); what the 20 ms of their torques cost, v 10 ms; what the wall gives by "
              "itself, the person's largest force over K and v sqrt(m / K) / e; depth over "
              "v^2 / (2 a), and over what it may be, {:g} v^2 / (2 a) and these two. Largest speed "
              "away from the wall over that of the impact, at most {:g}; when it is slower than "
              "{:g} mm/s for good, at most {:g} s; what the wall gives back of the energy that the "
              "device took with it, at most 100 %; largest forces of wall and person.",
              kDeepestImpact, kMostRebound, 1e3 * config.rest_speed, kLatestRest),
          .columns = {"hand", "kg", "N/m", "m/s", "deepest mm", "a m/s^2", "v^2/(2a) mm",
                      "onset mm", "spring mm", "over v^2/(2a)", "over allowed", "rebound", "rest s",
                      "energy back %", "wall N", "person N", "missed"}};
}

}  // namespace

void add_impacts(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values stiffness = is_quick ? Values{2e3, 5e4} : Values{2e3, 1e4, 2e4, 5e4};
  const ImpactConfig config;
  const std::vector<Thrown> bodies = thrown(group.scenario, is_quick);
  const Values ways = group.measure_all("run-up", bodies.size(), [&](std::size_t i) {
    return find_way(bodies[i].scenario, config, bodies[i].speed);
  });
  const std::size_t count = bodies.size() * stiffness.size();
  const auto all = group.measure_all("impacts", count, [&](std::size_t i) {
    const std::size_t body = i / stiffness.size();
    return measure_impact(bodies[body].scenario, config, stiffness[i % stiffness.size()],
                          bodies[body].speed, ways[body], group.seed(0));
  });
  Table table = table_for(config);
  double depth = 0.0, rebound = 0.0, rest = 0.0, energy = 0.0, misses = 0.0;
  bool has_all = true;
  for (std::size_t i = 0; i < count; ++i) {
    const Thrown& body = bodies[i / stiffness.size()];
    const double k = stiffness[i % stiffness.size()];
    const std::string what = fmt::format("impact, {} on {:g} N/m", body.name, k);
    if (!group.has_worked(what, all[i].failure)) {
      has_all = false;
      continue;
    }
    table.rows.push_back(row_of(body, k, all[i]));
    depth = std::max(depth, all[i].depth / all[i].allowed());
    rebound = std::max(rebound, all[i].rebound);
    rest = std::max(rest, all[i].rest_s);
    energy = std::max(energy, all[i].energy_out / all[i].energy_in);
    if (!missed(all[i]).empty()) misses += 1.0;
  }
  group.out.tables.push_back(table);
  const auto add = [&](const char* id, const char* name, const char* unit, double value,
                       double most, const std::string& note) {
    group.out.beyond.push_back({.id = id,
                                .name = name,
                                .unit = unit,
                                .goal = {.ub = most},
                                .values = has_all ? Values{value} : Values{},
                                .note = note});
  };
  add("impact_depth", "Depth of an impact over what it may be, largest", "", depth, 1.0,
      fmt::format(
          "{:g} v^2 / (2 a) with the a of the motors, and what their onset and the spring of "
          "the wall give",
          kDeepestImpact));
  add("impact_rebound", "Speed after an impact over that before, largest", "", rebound,
      kMostRebound, fmt::format("at most {:g} is asked for", kMostRebound));
  add("impact_rest", "Rest after an impact, latest", "s", rest, kLatestRest,
      fmt::format("at most {:g} s is asked for", kLatestRest));
  add("impact_energy", "Energy out of a wall over energy into it, largest", "", energy, 1.0,
      "at most 1 is asked for");
  add("impact_misses", "Impacts that miss one of these bounds", "", misses, 0.0,
      fmt::format("of {}, see the table", count));
}

}  // namespace hg::haptify

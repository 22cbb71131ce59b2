#include "hg/studies/haptify/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "hg/config/script_schema.h"
#include "hg/studies/changes.h"
#include "hg/studies/haptify/free_space.h"
#include "hg/studies/haptify/groups.h"
#include "hg/studies/haptify/response.h"
#include "hg/studies/haptify/surface.h"
#include "hg/studies/player.h"
#include "hg/studies/stability_map.h"

namespace hg::haptify {
namespace {

constexpr int kAxes = 3;

// Conditions of a run.
struct Condition {
  std::uint64_t seed = 0;
  double height = 0.0;  // height of the handle, m in B
  person::HandPreset hand = person::HandPreset::kNormal;
};

constexpr std::array kHands = {person::HandPreset::kRelaxed, person::HandPreset::kNormal,
                               person::HandPreset::kStiff};

std::vector<double> heights(const HaptifyOptions& options) {
  if (options.is_quick) return {-0.775};
  return {-1.05, -0.775, -0.55};
}

// Every seed at every height, in each of `hands`.
std::vector<Condition> conditions(const Group& group, std::span<const person::HandPreset> hands) {
  std::vector<Condition> all;
  for (std::size_t i = 0; i < group.repetitions(); ++i) {
    for (const double height : heights(group.options)) {
      for (const person::HandPreset hand : hands) all.push_back({group.seed(i), height, hand});
    }
  }
  return all;
}

std::vector<Condition> in_all_hands(const Group& group) {
  return conditions(group, group.options.is_quick ? std::span(kHands).subspan(1, 1) : kHands);
}

// Conditions for measurements that fix the hand or have none.
std::vector<Condition> in_one_hand(const Group& group, person::HandPreset hand) {
  return conditions(group, std::span(&hand, 1));
}

config::Scenario under(const Condition& condition, config::Scenario scenario) {
  studies::set_seed(scenario, condition.seed);
  scenario.script.hand = person::hand(condition.hand);
  scenario.twin.model.q_start[2] = condition.height;
  return scenario;
}

std::string name_of(person::HandPreset hand) {
  const auto found =
      std::ranges::find(config::kHandPresets, hand, &config::Choice<person::HandPreset>::value);
  return fmt::format("{} hand", found->name);
}

std::string words(const std::string& what, const Condition& condition) {
  return fmt::format("{}, seed {}, {:g} m, {}", what, condition.seed, condition.height,
                     name_of(condition.hand));
}

// The mean of `each` runs per condition, where all of them have worked.
template <typename Run>
std::vector<double> means(const Group& group, const std::string& what,
                          const std::vector<Condition>& all, std::size_t each,
                          const std::vector<Run>& found, double (*value)(const Run&)) {
  std::vector<double> result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double sum = 0.0;
    bool has_all = true;
    for (std::size_t k = 0; k < each; ++k) {
      const Run& one = found[each * i + k];
      has_all = group.has_worked(words(what, all[i]), one.failure) && has_all;
      sum += value(one);
    }
    if (has_all) result.push_back(sum / static_cast<double>(each));
  }
  return result;
}

std::string body_of(const config::Scenario& scenario) {
  const studies::FreeTwin body = studies::free_twin_of(scenario);
  return fmt::format("{:g} kg, {:g} Ns/m", body.mass, body.damping);
}

ResponseConfig response_at(double height, double force) {
  ResponseConfig config;
  config.frequency_Hz = {3, 5, 8, 12, 20, 30};
  config.least_s = 1.0;
  config.force = force;
  config.position.z() = height;
  return config;
}

// along the worst axis
void add_transparency(const Group& group, double force, double least_Hz) {
  const auto all = in_one_hand(group, person::HandPreset::kNormal);
  const std::string what = fmt::format("Transparency bandwidth, {:g} N", force);
  const auto found = group.measure_all(what, kAxes * all.size(), [&](std::size_t i) {
    const Condition& condition = all[i / kAxes];
    return measure_response(under(condition, group.scenario), response_at(condition.height, force),
                            static_cast<int>(i % kAxes), condition.seed);
  });
  Figure figure = {.id = fmt::format("transparency_{:g}N", force),
                   .name = what,
                   .unit = "Hz",
                   .digits = 1,
                   .goal = {.lb = least_Hz},
                   .note = "along the worst axis of the handle; an instrument pushes"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    double worst = kInfinity;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const Response& one = found[kAxes * i + axis];
      if (group.has_worked(words(what, all[i]), one.failure)) {
        worst = std::min(worst, transparency_Hz(one));
      }
    }
    if (std::isfinite(worst)) figure.values.push_back(worst);
  }
  group.out.beyond.push_back(figure);
}

void add_latencies(const Group& group) {
  const auto all = in_one_hand(group, person::HandPreset::kNormal);
  const std::string what = "Latency from wrench to motion";
  const auto found = group.measure_all(what, kAxes * all.size(), [&](std::size_t i) {
    const Condition& condition = all[i / kAxes];
    return measure_latency(under(condition, group.scenario), response_at(condition.height, 10.0),
                           static_cast<int>(i % kAxes), condition.seed);
  });
  Figure figure = {.id = "latency",
                   .name = what,
                   .unit = "ms",
                   .goal = {.ub = 4.5},
                   .note = "after a step of 10 N; mean of three axes"};
  figure.values = means<Latency>(group, what, all, kAxes, found,
                                 [](const Latency& one) { return 1e3 * one.motion_s; });
  group.out.beyond.push_back(figure);
}

// Name, goal and value of a figure of strokes.
struct StrokeFigure {
  Figure figure;
  double (*of)(const FreeSpace&);
};

double vibration_of(const FreeSpace& one) { return one.vibration_rms; }

std::vector<StrokeFigure> stroke_figures() {
  return {
      {{.id = "free_space_extra",
        .name = "Force that the device adds",
        .unit = "N",
        .goal = {.ub = 0.10},
        .note = "random strokes: mean norm of f - (m a + b v), below 20 Hz"},
       [](const FreeSpace& one) { return one.extra; }},
      {{.id = "vibration",
        .name = "Vibration",
        .unit = "m/s^2",
        .digits = 3,
        .goal = {.ub = 0.04},
        .note = "the same strokes, rms above 20 Hz"},
       vibration_of},
      {{.id = "centroid",
        .name = "Its spectral centroid",
        .unit = "Hz",
        .digits = 1,
        .goal = {.lb = 90.0},
        .note = "of that signal"},
       [](const FreeSpace& one) { return one.centroid_Hz; }},
      {{.id = "distance",
        .name = "Hand to twin",
        .unit = "mm",
        .goal = {.ub = 0.3},
        .note = "the same strokes, rms"},
       [](const FreeSpace& one) { return 1e3 * one.distance_rms; }},
  };
}

std::vector<StrokeFigure> light_stroke_figures(const std::string& body) {
  return {
      {{.id = "free_space_force",
        .name = "Free-space force",
        .unit = "N",
        .goal = {.ub = 0.87},
        .note = "random strokes of a body of " + body + ", mean norm"},
       [](const FreeSpace& one) { return one.force; }},
      {{.id = "vibration_light",
        .name = "Vibration of that body",
        .unit = "m/s^2",
        .digits = 3,
        .note = "the same strokes, rms above 20 Hz: the price of a light body"},
       vibration_of},
  };
}

// Strokes at one height.
void add_strokes(const Group& group, std::vector<StrokeFigure> figures) {
  const auto all = in_all_hands(group);
  const std::string what = "Free space, body of " + body_of(group.scenario);
  const auto found = group.measure_all(what, all.size(), [&](std::size_t i) {
    FreeSpaceConfig config;
    config.duration_s = group.options.is_quick ? 6.0 : 22.0;
    config.lower.z() = config.upper.z() = all[i].height;
    return measure_free_space(under(all[i], group.scenario), config, all[i].seed);
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!group.has_worked(words(what, all[i]), found[i].failure)) continue;
    for (StrokeFigure& one : figures) one.figure.values.push_back(one.of(found[i]));
  }
  for (const StrokeFigure& one : figures) group.out.beyond.push_back(one.figure);
}

void add_light_body(const Group& group, person::HandPreset hand, double mass) {
  constexpr double kDamping = 4.0;  // Ns/m
  const auto all = in_one_hand(group, hand);
  const std::string what = fmt::format("{:g} kg after a kick, {}", mass, name_of(hand));
  const auto found = group.measure_all(what, all.size(), [&](std::size_t i) {
    studies::StabilityConfig config;
    config.position.z() = all[i].height;
    return kick(under(all[i], group.scenario), config, person::hand(hand), mass, kDamping)
        .last_speed;
  });
  Figure figure = {.id = fmt::format("kick_{:g}kg", mass),
                   .name = fmt::format("Speed of {:g} kg after a kick", mass),
                   .unit = "mm/s",
                   .digits = 1,
                   .goal = {.ub = 6.0},
                   .note = "largest in the fourth second"};
  for (const double speed : found) figure.values.push_back(1e3 * speed);
  group.out.beyond.push_back(figure);
}

void add_wall(const Group& group, double mass) {
  constexpr double kStiffness = 20e3, kWallDamping = 20.0, kDamping = 4.0;  // N/m, Ns/m, Ns/m
  const auto all = in_all_hands(group);
  const std::string what = fmt::format("Plane of 20 kN/m under {:g} kg", mass);
  const auto found = group.measure_all(what, all.size(), [&](std::size_t i) {
    config::Scenario scenario = under(all[i], group.scenario);
    studies::set_free_twin(scenario, {.mass = mass, .damping = kDamping});
    SurfaceConfig config;
    config.position.z() = all[i].height;
    config.knock_hand = all[i].hand;
    return knock(scenario, config, kStiffness, kWallDamping);
  });
  Figure figure = {.id = fmt::format("wall_{:g}kg", mass),
                   .name = what + ": calm",
                   .unit = "",
                   .digits = 0,
                   .goal = {.lb = 1.0},
                   .note = fmt::format("1 calm, 0 not; pressed with 10 N and kicked, plane with "
                                       "{:g} Ns/m, body with {:g} Ns/m",
                                       kWallDamping, kDamping)};
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!group.has_worked(words(what, all[i]), found[i].failure)) continue;
    figure.values.push_back(found[i].verdict == studies::DecayClass::kStable ? 1.0 : 0.0);
  }
  group.out.beyond.push_back(figure);
}

SurfaceConfig surface_at(double height) {
  SurfaceConfig config;
  config.position.z() = height;
  return config;
}

void add_slides(const Group& group) {
  const auto all = in_all_hands(group);
  const std::string what = "Frictionless surface";
  const auto found = group.measure_all(what, all.size(), [&](std::size_t i) {
    SurfaceConfig config = surface_at(all[i].height);
    config.strokes = group.options.is_quick ? 1 : 2;
    return measure_slide(under(all[i], group.scenario), config, all[i].seed);
  });
  Figure figure = {
      .id = "frictionless_surface",
      .name = "Frictionless surface force",
      .unit = "N",
      .goal = {.ub = 0.4},
      .note = "tangential, strokes of 0.2 m in 2 s, body of " + body_of(group.scenario)};
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (group.has_worked(words(what, all[i]), found[i].failure)) {
      figure.values.push_back(found[i].force);
    }
  }
  group.out.beyond.push_back(figure);
}

void add_presses(const Group& group) {
  constexpr std::array kStiffness = {1000.0, 2000.0, 4000.0};  // N/m
  const auto all = in_one_hand(group, person::HandPreset::kStiff);
  const std::string what = "Stiffness accuracy";
  const std::size_t n = kStiffness.size();
  const auto found = group.measure_all(what, n * all.size(), [&](std::size_t i) {
    SurfaceConfig config = surface_at(all[i / n].height);
    if (group.options.is_quick) config.press_s = 1.5;
    return measure_press(under(all[i / n], group.scenario), config, kStiffness[i % n],
                         all[i / n].seed);
  });
  Figure figure = {.id = "stiffness_accuracy",
                   .name = what,
                   .unit = "%",
                   .digits = 1,
                   .goal = {.lb = 99.0, .ub = 101.0},
                   .note = "mean of 1000, 2000 and 4000 N/m, pressed slowly up to 40 N"};
  figure.values =
      means<Press>(group, what, all, n, found, [](const Press& one) { return one.accuracy; });
  group.out.beyond.push_back(figure);
}

}  // namespace

Benchmark measure_goals(const config::Scenario& scenario, const config::Scenario& light,
                        const HaptifyOptions& options, const Told& told) {
  Benchmark result = {.options = options, .device = scenario.device.name};
  const Group group = {scenario, options, told, result};
  const Group with_light_body = {light, options, told, result};
  add_transparency(group, 10.0, 14.0);
  add_transparency(group, 40.0, 8.0);
  add_latencies(group);
  add_strokes(group, stroke_figures());
  add_light_body(group, person::HandPreset::kNormal, 0.3);
  add_light_body(group, person::HandPreset::kStiff, 0.4);
  add_wall(group, 6.0);
  add_wall(group, 3.0);
  add_presses(group);
  add_strokes(with_light_body, light_stroke_figures(body_of(light)));
  add_slides(with_light_body);
  return result;
}

Table goals_table(const Benchmark& goals) {
  Table table = {
      .id = "goals",
      .title = "Goals over seeds, heights and hands",
      .columns = {"figure", "unit", "goal", "median", "least", "largest", "within", "conditions"}};
  for (const Figure& figure : goals.beyond) {
    std::vector<double> values = figure.values;
    std::ranges::sort(values);
    const auto within =
        std::ranges::count_if(values, [&](double value) { return figure.goal.contains(value); });
    const auto at = [&](std::size_t i) { return fmt::format("{:.{}f}", values[i], figure.digits); };
    const bool is_there = !values.empty();
    table.rows.push_back(
        {figure.name, figure.unit, to_text(figure.goal), is_there ? at(values.size() / 2) : "-",
         is_there ? at(0) : "-", is_there ? at(values.size() - 1) : "-",
         figure.goal.bounded() ? fmt::format("{} of {}", within, values.size()) : "-",
         figure.note});
  }
  return table;
}

}  // namespace hg::haptify

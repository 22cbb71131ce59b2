// Frictionless surface, stiffness, peak force and Z-width.

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/studies/changes.h"
#include "hg/studies/haptify/groups.h"
#include "hg/studies/haptify/surface.h"

namespace hg::haptify {

void add_sliding(const Group& group) {
  SurfaceConfig config;
  if (group.options.is_quick) config.strokes = 1;
  config::Scenario light = group.scenario;
  studies::set_free_twin(light, kLightBody);
  SurfaceConfig slow = config;
  slow.stroke_s *= 2.0;
  const std::size_t n = group.repetitions();
  const auto all = group.measure_all("frictionless surface", 3 * n, [&](std::size_t i) {
    const config::Scenario& scenario = i / n == 1 ? light : group.scenario;
    return measure_slide(scenario, i / n == 2 ? slow : config, group.seed(i % n));
  });
  std::vector<double> force, own, inertial, viscous, extra, normal, speed, lighter, slower;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Slide& one = all[i];
    const char* const kinds[] = {"", ", lighter body", ", slower strokes"};
    const std::string what =
        fmt::format("frictionless surface{}, seed {}", kinds[i / n], group.seed(i % n));
    if (!group.has_worked(what, one.failure)) continue;
    if (i >= n) {
      (i / n == 1 ? lighter : slower).push_back(one.force);
      continue;
    }
    force.push_back(one.force);
    own.push_back(one.own_share);
    inertial.push_back(one.inertial);
    viscous.push_back(one.viscous);
    extra.push_back(one.extra);
    normal.push_back(one.normal);
    speed.push_back(one.speed);
  }
  group.out.table.push_back(
      {.id = "frictionless_surface",
       .name = "Frictionless surface rendering force",
       .unit = "N",
       .published = {1.96, 0.53, 0.38},
       .goal = {.ub = 0.4},
       .values = force,
       .note = fmt::format("tangential, on a plane of {:g} N/m; strokes of {:g} m at {:.2f} m/s on "
                           "average, pressed with {:.1f} N",
                           config.slide_stiffness, config.stroke, mean_value(speed),
                           mean_value(normal)),
       .why = fmt::format(
           "{:.2f} N of it is what the rendered body needs for the strokes (mass times "
           "acceleration {:.2f} N, damping times velocity {:.2f} N on average); device and surface "
           "add {:.2f} N to that (mean norm of the difference). Rendered as {:g} kg, {:g} Ns/m it "
           "is {:.2f} N; with strokes of {:g} instead of {:g} s it is {:.2f} N. The goal lies "
           "between Touch X and Touch, which render no body.",
           mean_value(own), mean_value(inertial), mean_value(viscous), mean_value(extra),
           kLightBody.mass, kLightBody.damping, mean_value(lighter), slow.stroke_s, config.stroke_s,
           mean_value(slower))});
  group.out.beyond.push_back({.id = "frictionless_surface_extra",
                              .name = "Frictionless surface force that device and surface add",
                              .unit = "N",
                              .values = extra,
                              .note = "tangential, mean norm of f - (m a + b v)"});
}

void add_stiffness(const Group& group) {
  const std::vector<double> stiffness = group.options.is_quick
                                            ? std::vector<double>{2000.0}
                                            : std::vector<double>{1000.0, 2000.0, 4000.0};
  SurfaceConfig config;
  if (group.options.is_quick) config.press_s = 1.5;
  const std::size_t n = group.repetitions();
  const auto all = group.measure_all("stiffness", n * stiffness.size(), [&](std::size_t i) {
    return measure_press(group.scenario, config, stiffness[i / n], group.seed(i % n));
  });
  Figure accuracy = {
      .id = "stiffness_accuracy",
      .name = "Stiffness rendering accuracy",
      .unit = "%",
      .digits = 1,
      .published = {109, 47, 80},
      .goal = {.lb = 99.0, .ub = 101.0},
      .note = fmt::format("slope of force over depth while a stiff hand presses slowly "
                          "up to {:g} N on a plane; mean of {:g} N/m",
                          config.press_force, fmt::join(stiffness, ", "))};
  Table table = {.id = "stiffness",
                 .title = "Stiffness of virtual surfaces",
                 .note =
                     "Depth of the handle, and of the rendered body alone: the difference is "
                     "how far the device is behind its reference under load.",
                 .columns = {"N/m", "accuracy %", "of the rendered body %", "largest force N"}};
  std::vector<double> twin;
  std::vector<std::vector<double>> of_repetition(n);
  for (std::size_t k = 0; k < stiffness.size(); ++k) {
    std::vector<double> slopes, rendered, force;
    for (std::size_t i = 0; i < n; ++i) {
      const Press& one = all[k * n + i];
      const std::string what =
          fmt::format("stiffness {:g} N/m, seed {}", stiffness[k], group.seed(i));
      if (!group.has_worked(what, one.failure)) continue;
      slopes.push_back(one.accuracy);
      rendered.push_back(one.twin_accuracy);
      force.push_back(one.force);
      of_repetition[i].push_back(one.accuracy);
    }
    if (slopes.empty()) continue;
    twin.push_back(mean_value(rendered));
    const Mean slope = mean_of(slopes);
    table.rows.push_back({fmt::format("{:g}", stiffness[k]),
                          fmt::format("{:.2f} +- {:.2f}", slope.value, slope.half_width),
                          fmt::format("{:.2f}", mean_value(rendered)),
                          fmt::format("{:.1f}", mean_value(force))});
  }
  for (const std::vector<double>& all_slopes : of_repetition) {
    if (all_slopes.size() == stiffness.size()) accuracy.values.push_back(mean_value(all_slopes));
  }
  accuracy.why = fmt::format(
      "With the depth of the rendered body instead of the handle it is {:.1f} %, where mass and "
      "damping of body and surface add to the spring; the rest is how far the joints give way.",
      mean_value(twin));
  group.out.table.push_back(accuracy);
  group.out.tables.push_back(table);
}

void add_peak(const Group& group) {
  SurfaceConfig config;
  if (group.options.is_quick) config.peak_s = 3.0;
  const auto all = group.measure_all("peak force", group.repetitions(), [&](std::size_t i) {
    return measure_peak(group.scenario, config, group.seed(i));
  });
  Figure figure = {.id = "stiffness_peak_force",
                   .name = "Stiffness peak force",
                   .unit = "N",
                   .digits = 1,
                   .published = {76.7, 2.7, 5.7},
                   .goal = {.lb = 80.0},
                   .note = fmt::format("on a plane of {:g} N/m, within {:g} % of its line; the "
                                       "person stops at {:g} N, the monitor would at {:g} N",
                                       config.peak_stiffness, 100.0 * config.peak_tolerance,
                                       config.peak_force, group.scenario.device.monitor.force_max)};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string what = fmt::format("peak force, seed {}", group.seed(i));
    if (!group.has_worked(what, all[i].failure)) continue;
    if (figure.values.empty()) {
      figure.why = "It ended: " + all[i].end + ".";
      figure.note += "; it ended: " + all[i].end;
    }
    figure.values.push_back(all[i].force);
  }
  group.out.table.push_back(figure);
}

namespace {

// A free body on the surfaces of the map, and how late the device learns what the person does.
struct MapBody {
  studies::FreeTwin twin;
  bool is_prompt = false;  ///< the wrench and what it is compensated with without any delay
};

config::Scenario with_body(config::Scenario scenario, const MapBody& body) {
  studies::set_free_twin(scenario, body.twin);
  if (!body.is_prompt) return scenario;
  scenario.device.simulation.sensors.wrench.filter = {.average = 0.0, .delay = 0.0};
  scenario.device.simulation.sensors.imu_filter = {.average = 0.0, .delay = 0.0};
  scenario.device.estimation.wrench.low_pass_Hz = 0.0;
  return scenario;
}

Table z_width_table(const std::vector<double>& damping) {
  Table table = {
      .id = "z_width",
      .title = "Z-width: which surfaces stay calm",
      .note =
          "A normal hand presses with 10 N on a plane and is kicked (15 N for 10 ms); "
          "the rows are body and stiffness, with the frequency at which the body would "
          "swing on the spring alone, the columns damping of the plane. Prompt: the wrench "
          "without the delays of sensor and low-pass.",
      .columns = {"body", "N/m", "Hz"}};
  for (const double value : damping) table.columns.push_back(fmt::format("{:g} Ns/m", value));
  return table;
}

}  // namespace

double stiffest_calm(std::span<const double> stiffness,
                     std::span<const studies::DecayClass> verdicts) {
  double most = 0.0;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    if (verdicts[i] != studies::DecayClass::kStable) break;
    most = stiffness[i];
  }
  return most;
}

void add_z_width(const Group& group) {
  const bool is_quick = group.options.is_quick;
  using Values = std::vector<double>;
  const Values stiffness =
      is_quick ? Values{1000, 8000} : Values{1000, 4000, 8000, 16000, 32000, 50000};
  const Values damping = is_quick ? Values{0} : Values{0, 20, 100, 400};
  std::vector<MapBody> bodies = {{studies::free_twin_of(group.scenario)}, {kLightBody}};
  if (!is_quick) bodies.push_back({kLightBody, true});
  const SurfaceConfig config;
  const std::size_t columns = damping.size(), rows = stiffness.size();
  const auto knocks =
      group.measure_all("Z-width", bodies.size() * rows * columns, [&](std::size_t i) {
        return knock(with_body(group.scenario, bodies[i / (rows * columns)]), config,
                     stiffness[i / columns % rows], damping[i % columns]);
      });
  Table table = z_width_table(damping);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const MapBody& body = bodies[k];
    const std::string name = fmt::format("{:g} kg, {:g} Ns/m{}", body.twin.mass, body.twin.damping,
                                         body.is_prompt ? ", prompt" : "");
    std::vector<studies::DecayClass> undamped;
    bool has_failed = false;
    for (std::size_t row = 0; row < rows; ++row) {
      const double swing = std::sqrt(stiffness[row] / body.twin.mass) / (2.0 * std::numbers::pi);
      table.rows.push_back(
          {name, fmt::format("{:g}", stiffness[row]), fmt::format("{:.1f}", swing)});
      const std::span found = std::span(knocks).subspan((k * rows + row) * columns, columns);
      for (std::size_t column = 0; column < columns; ++column) {
        const std::string what =
            fmt::format("Z-width, {}, {:g} N/m, {:g} Ns/m", name, stiffness[row], damping[column]);
        const bool has_worked = group.has_worked(what, found[column].failure);
        table.rows.back().emplace_back(has_worked ? to_string(found[column].verdict) : "failed");
      }
      has_failed = has_failed || !found.front().failure.empty();
      undamped.push_back(found.front().verdict);
    }
    if (body.is_prompt || has_failed) continue;
    group.out.beyond.push_back(
        {.id = k == 0 ? "z_width" : "z_width_light",
         .name = "Stiffest calm surface, body of " + name,
         .unit = "N/m",
         .digits = 0,
         .values = {stiffest_calm(stiffness, undamped)},
         .note = fmt::format("of the map below, plane without damping; {:g} N/m is the most that a "
                             "surface may have",
                             surfaces::kStiffness.ub)});
  }
  group.out.tables.push_back(table);
}

}  // namespace hg::haptify

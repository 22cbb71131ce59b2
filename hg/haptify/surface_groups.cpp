// Frictionless surface, stiffness, peak force and Z-width.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "hg/experiments/changes.h"
#include "hg/haptify/groups.h"
#include "hg/haptify/surface.h"

namespace hg::haptify {
void add_sliding(const Group& group) {
  SurfaceConfig config;
  if (group.options.is_quick) config.strokes = 1;
  config::Scenario light = group.scenario;
  experiments::set_free_twin(light, kLightBody);
  const std::size_t n = group.repetitions();
  const auto all = group.measure_all("frictionless surface", 2 * n, [&](std::size_t i) {
    return measure_slide(i < n ? group.scenario : light, config, group.seed(i % n));
  });
  std::vector<double> force, own, extra, normal, speed, lighter;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Slide& one = all[i];
    group.add_failure(fmt::format("frictionless surface, seed {}", group.seed(i % n)), one.failure);
    if (i >= n) {
      lighter.push_back(one.force);
      continue;
    }
    force.push_back(one.force);
    own.push_back(one.own_share);
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
           "acceleration, damping times velocity); device and surface add {:.2f} N to that (mean "
           "norm of the difference). Rendered as {:g} kg, {:g} Ns/m it is {:.2f} N.",
           mean_value(own), mean_value(extra), kLightBody.mass, kLightBody.damping,
           mean_value(lighter))});
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
  Figure accuracy = {.id = "stiffness_accuracy",
                     .name = "Stiffness rendering accuracy",
                     .unit = "%",
                     .digits = 1,
                     .published = {109, 47, 80},
                     .goal = {.lb = 99.0, .ub = 101.0},
                     .note =
                         "slope of force over depth while a stiff hand presses slowly up to "
                         "40 N on a plane; mean of 1000, 2000 and 4000 N/m"};
  Table table = {.id = "stiffness",
                 .title = "Stiffness of virtual surfaces",
                 .note =
                     "Depth of the handle, and of the rendered body alone: the difference is "
                     "how far the device is behind its reference under load.",
                 .columns = {"N/m", "accuracy %", "of the rendered body %", "largest force N"}};
  std::vector<double> twin;
  accuracy.values.assign(n, 0.0);
  for (std::size_t k = 0; k < stiffness.size(); ++k) {
    std::vector<double> slopes, rendered, force;
    for (std::size_t i = 0; i < n; ++i) {
      const Press& one = all[k * n + i];
      group.add_failure(fmt::format("stiffness {:g} N/m, seed {}", stiffness[k], group.seed(i)),
                        one.failure);
      slopes.push_back(one.accuracy);
      rendered.push_back(one.twin_accuracy);
      force.push_back(one.force);
      accuracy.values[i] += one.accuracy / static_cast<double>(stiffness.size());
    }
    twin.push_back(mean_value(rendered));
    const Mean slope = mean_of(slopes);
    table.rows.push_back({fmt::format("{:g}", stiffness[k]),
                          fmt::format("{:.2f} +- {:.2f}", slope.value, slope.half_width),
                          fmt::format("{:.2f}", mean_value(rendered)),
                          fmt::format("{:.1f}", mean_value(force))});
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
    group.add_failure(fmt::format("peak force, seed {}", group.seed(i)), all[i].failure);
    figure.values.push_back(all[i].force);
  }
  figure.why = "It ended: " + all.front().end + ".";
  figure.note += "; it ended: " + all.front().end;
  group.out.table.push_back(figure);
}

void add_z_width(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const std::vector<double> stiffness =
      is_quick ? std::vector<double>{1000, 8000}
               : std::vector<double>{500, 1000, 2000, 4000, 8000, 16000};
  const std::vector<double> damping =
      is_quick ? std::vector<double>{20} : std::vector<double>{0, 20, 50, 100, 200, 400};
  const SurfaceConfig config;
  const auto verdicts =
      group.measure_all("Z-width", stiffness.size() * damping.size(), [&](std::size_t i) {
        return knock(group.scenario, config, stiffness[i / damping.size()],
                     damping[i % damping.size()]);
      });
  Table table = {.id = "z_width",
                 .title = "Z-width: which surfaces stay calm",
                 .note =
                     "A normal hand presses with 10 N on a plane and is kicked (15 N for 10 "
                     "ms); the rows are stiffness, the columns damping of the plane.",
                 .columns = {"N/m"}};
  for (const double value : damping) table.columns.push_back(fmt::format("{:g} Ns/m", value));
  Figure widest = {.id = "z_width",
                   .name = "Stiffest calm surface",
                   .unit = "N/m",
                   .digits = 0,
                   .note = "of the map below, with the damping that suits it"};
  double most = 0.0;
  for (std::size_t row = 0; row < stiffness.size(); ++row) {
    table.rows.push_back({fmt::format("{:g}", stiffness[row])});
    for (std::size_t column = 0; column < damping.size(); ++column) {
      const experiments::Verdict verdict = verdicts[row * damping.size() + column];
      table.rows.back().emplace_back(to_string(verdict));
      if (verdict == experiments::Verdict::kStable) most = std::max(most, stiffness[row]);
    }
  }
  widest.values = {most};
  group.out.beyond.push_back(widest);
  group.out.tables.push_back(table);
}

}  // namespace hg::haptify

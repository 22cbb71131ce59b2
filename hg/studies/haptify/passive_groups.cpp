// Workspace, free space and strokes: what needs no virtual surface and no frequency.

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "hg/studies/changes.h"
#include "hg/studies/haptify/dynamics.h"
#include "hg/studies/haptify/free_space.h"
#include "hg/studies/haptify/groups.h"
#include "hg/studies/haptify/shape.h"

namespace hg::haptify {
namespace {

// one field of all repetitions
template <typename Result>
std::vector<double> values_of(const std::vector<Result>& results, double Result::*field) {
  std::vector<double> values;
  for (const Result& result : results) values.push_back(result.*field);
  return values;
}

std::string range_text(const Interval& range) {
  return fmt::format("{:.2f} .. {:.2f} m", range.lb, range.ub);
}

// Its vibration, and what the device adds.
void add_vibration(const Group& group, const std::vector<FreeSpace>& shipped,
                   const std::vector<FreeSpace>& lighter) {
  group.out.table.push_back({.id = "free_space_vibration",
                             .name = "Free-space vibration, RMS",
                             .unit = "m/s^2",
                             .digits = 3,
                             .published = {0.81, 0.07, 0.04},
                             .goal = {.ub = 0.1},
                             .values = values_of(shipped, &FreeSpace::vibration_rms),
                             .note = "of the same strokes; above 20 Hz, DFT321"});
  group.out.table.push_back({.id = "free_space_centroid",
                             .name = "Free-space vibration, spectral centroid",
                             .unit = "Hz",
                             .digits = 1,
                             .published = {77.3, 123.0, 162.8},
                             .goal = {.lb = 90.0},
                             .values = values_of(shipped, &FreeSpace::centroid_Hz),
                             .note = "of the same signal, 20 to 500 Hz, weighted with magnitude"});
  const auto beyond = [&](const char* id, const std::string& name, const char* unit, int digits,
                          const std::vector<double>& values, const std::string& note) {
    group.out.beyond.push_back(
        {.id = id, .name = name, .unit = unit, .digits = digits, .values = values, .note = note});
  };
  beyond("free_space_extra", "Free-space force that the device adds", "N", 2,
         values_of(shipped, &FreeSpace::extra), "mean norm of f - (m a + b v), below 20 Hz");
  beyond("free_space_force_light",
         fmt::format("Mean free-space force, body of {:g} kg, {:g} Ns/m", kLightBody.mass,
                     kLightBody.damping),
         "N", 2, values_of(lighter, &FreeSpace::force), "the same strokes");
  beyond("free_space_vibration_light", "Free-space vibration of that body, RMS", "m/s^2", 3,
         values_of(lighter, &FreeSpace::vibration_rms), "the same strokes");
  const std::string seen = fmt::format(
      "true vibration plus the noise of an accelerometer like the device's own, {:g} "
      "m/s^2/sqrt(Hz)",
      group.scenario.device.simulation.sensors.accelerometer.noise);
  beyond("free_space_vibration_seen", "Free-space vibration as an accelerometer shows it, RMS",
         "m/s^2", 3, values_of(shipped, &FreeSpace::seen_rms), seen);
  beyond("free_space_centroid_seen", "Its spectral centroid", "Hz", 1,
         values_of(shipped, &FreeSpace::seen_centroid_Hz), "of that signal");
}

}  // namespace

void add_workspace(const Group& group) {
  const ShapeConfig config = {.postures = group.options.is_quick ? 4'000 : 60'000};
  const auto shapes = group.measure_all("workspace", group.repetitions(), [&](std::size_t i) {
    return measure_shape(group.scenario.device, config, group.seed(i));
  });
  Figure volume = {.id = "workspace_volume",
                   .name = "Workspace volume",
                   .unit = "m^3",
                   .published = {12.2, 11.8e-3, 10.4e-3},
                   .goal = {.lb = 12.2},
                   .note =
                       "of the handle in any orientation: joint limits, distance to the "
                       "singularity, travel of the gantry and walls all hold"};
  Figure nominal = {.id = "workspace_nominal",
                    .name = "Workspace in the nominal orientation",
                    .unit = "m^3",
                    .note = "the handle as in the goal posture of prepositioning"};
  for (const checks::HandleWorkspace& shape : shapes) {
    volume.values.push_back(shape.volume);
    nominal.values.push_back(shape.share_nominal * shape.box_volume);
  }
  const checks::HandleWorkspace& first = shapes.front();
  if (first.has_box) {
    volume.why = fmt::format(
        "The limits of the handle are a box of {:.2f} m^3, and {:.1f} % of it is reached.",
        first.box_volume, 100.0 * mean_value(volume.values) / first.box_volume);
    volume.why += unreached_sides(group.scenario.device, first, config, group.seed(0));
  }
  Table shape = {.id = "workspace_shape",
                 .title = "Workspace shape",
                 .note = "bounds of all points that the handle reached",
                 .columns = {"axis", "reached", "edge m"}};
  const char* names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const Interval range = {first.bounds.min()[axis], first.bounds.max()[axis]};
    shape.rows.push_back(
        {names[axis], range_text(range), fmt::format("{:.2f}", range.ub - range.lb)});
  }
  shape.rows.push_back(
      {"mean edge", "cube of the same volume", fmt::format("{:.2f}", std::cbrt(first.volume))});
  group.out.workspace = workspace_views(group.scenario.device, config, group.seed(0));
  group.out.table.push_back(volume);
  group.out.beyond.push_back(nominal);
  group.out.tables.push_back(shape);
}

void add_free_space(const Group& group) {
  FreeSpaceConfig config;
  if (group.options.is_quick) config.duration_s = 6.0;
  const studies::FreeTwin twin = studies::free_twin_of(group.scenario);
  config::Scenario light = group.scenario;
  studies::set_free_twin(light, kLightBody);
  const std::size_t n = group.repetitions();
  const auto all = group.measure_all("free space", 2 * n, [&](std::size_t i) {
    const config::Scenario& scenario = i < n ? group.scenario : light;
    return measure_free_space(scenario, config, group.seed(i % n));
  });
  std::vector<FreeSpace> shipped, lighter;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double mass = i < n ? twin.mass : kLightBody.mass;
    const std::string what =
        fmt::format("free space, body of {:g} kg, seed {}", mass, group.seed(i % n));
    if (group.has_worked(what, all[i].failure)) (i < n ? shipped : lighter).push_back(all[i]);
  }

  const std::string body =
      fmt::format("a free body of {:g} kg, {:g} Ns/m", twin.mass, twin.damping);
  const std::string walk = fmt::format(
      "{}; {:.0f} s, {:.1f} m of random strokes through the workspace at {:.2f} m/s rms", body,
      config.duration_s, mean_value(values_of(shipped, &FreeSpace::path)),
      mean_value(values_of(shipped, &FreeSpace::speed_rms)));
  group.out.table.push_back(
      {.id = "free_space_force",
       .name = "Mean free-space force",
       .unit = "N",
       .published = {1.28, 0.98, 0.87},
       .goal = {.ub = 0.7},
       .values = values_of(shipped, &FreeSpace::force),
       .note = walk,
       .why = fmt::format(
           "{:.2f} N of it is what {} needs for this motion (mass times acceleration, damping "
           "times velocity); the device adds {:.2f} N to that (mean norm of the difference). "
           "Rendered as {:g} kg, {:g} Ns/m on the same strokes it is {:.2f} N.",
           mean_value(values_of(shipped, &FreeSpace::own_share)), body,
           mean_value(values_of(shipped, &FreeSpace::extra)), kLightBody.mass, kLightBody.damping,
           mean_value(values_of(lighter, &FreeSpace::force)))});
  add_vibration(group, shipped, lighter);
  if (!shipped.empty()) {
    group.out.curves.push_back(
        vibration_curve("free_space", fmt::format("body of {:g} kg", twin.mass), shipped.front()));
  }
  if (!lighter.empty()) {
    group.out.curves.push_back(vibration_curve(
        "free_space", fmt::format("body of {:g} kg", kLightBody.mass), lighter.front()));
  }
}

void add_dynamics(const Group& group) {
  DynamicsConfig config;
  if (group.options.is_quick) {
    config.duration_s = {0.8};
    config.strokes = 2;
  }
  const std::size_t n = group.repetitions();
  const auto all = group.measure_all("strokes", n * kStrokeAxes, [&](std::size_t i) {
    return measure_dynamics(group.scenario, config, static_cast<int>(i / n), group.seed(i % n));
  });
  Table table = {.id = "local_dynamics",
                 .title = "Local dynamic forces and torques",
                 .note =
                     "Fit f = inertia a + damping v + friction sign v along (about) each axis, "
                     "mean and half width of the 95 % confidence interval; R^2 is how "
                     "predictable the force is.",
                 .columns = {"axis", "inertia", "damping", "friction", "R^2", "mean", "largest"}};
  for (std::size_t axis = 0; axis < kStrokeAxes; ++axis) {
    std::array<std::vector<double>, 6> columns;
    for (std::size_t i = 0; i < n; ++i) {
      const Dynamics& one = all[axis * n + i];
      const std::string what =
          fmt::format("strokes, {}, seed {}", kStrokeNames[axis], group.seed(i));
      if (!group.has_worked(what, one.failure)) continue;
      const double values[] = {one.fit.inertia, one.fit.damping, one.fit.friction,
                               one.fit.r2,      one.mean,        one.largest};
      for (std::size_t k = 0; k < columns.size(); ++k) columns[k].push_back(values[k]);
    }
    if (columns[0].empty()) continue;
    const bool is_force = axis < 3;
    const char* units_force[] = {"kg", "Ns/m", "N", "", "N", "N"};
    const char* units_torque[] = {"kg m^2", "Nms/rad", "Nm", "", "Nm", "Nm"};
    table.rows.push_back({kStrokeNames[axis]});
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const Mean mean = mean_of(columns[k]);
      const int digits = k == 3 ? 4 : 3;
      table.rows.back().push_back(fmt::format("{:.{}f} +- {:.{}f} {}", mean.value, digits,
                                              mean.half_width, digits,
                                              is_force ? units_force[k] : units_torque[k]));
    }
  }
  group.out.tables.push_back(table);
}

}  // namespace hg::haptify

// Transparency, bandwidths and latency.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "hg/studies/haptify/groups.h"
#include "hg/studies/haptify/measures.h"
#include "hg/studies/haptify/response.h"

namespace hg::haptify {
namespace {

constexpr int kAxes = 3;

double degrees(const std::complex<double>& value) {
  return std::arg(value) * 180.0 / std::numbers::pi;
}

ResponseConfig config_of(const HaptifyOptions& options) {
  ResponseConfig config;
  if (!options.is_quick) return config;
  config.frequency_Hz = {1, 5, 20};
  config.periods = 3;
  config.least_s = 0.6;
  return config;
}

// of all axes
void keep_lowest(double value, Figure& figure) {
  if (figure.values.empty() || value < figure.values[0]) figure.values = {value};
}

std::string amount(double value) { return fmt::format("{:.3g}", value); }

}  // namespace

void add_transparency(const Group& group) {
  const ResponseConfig config = config_of(group.options);
  const auto axes = group.measure_all("transparency", kAxes, [&](std::size_t i) {
    return measure_response(group.scenario, config, static_cast<int>(i), group.seed(0));
  });
  Table table = {.id = "transparency",
                 .title = "Transparency: impedance at the handle over the rendered body's",
                 .note =
                     "The person pushes to and fro along one axis of the handle with 10 N; "
                     "true force over true velocity. 1 and 0 degrees: the body itself.",
                 .columns = {"axis", "frequency Hz", "felt Ns/m", "body Ns/m", "ratio", "phase deg",
                             "handle over twin", "phase deg"}};
  Figure felt = {
      .id = "transparency_bandwidth",
      .name = "Transparency bandwidth",
      .unit = "Hz",
      .digits = 1,
      .note =
          "up to here the felt impedance is within 3 dB of the body's, along the worst axis of "
          "the handle"};
  Figure position = {.id = "position_bandwidth",
                     .name = "Position bandwidth",
                     .unit = "Hz",
                     .digits = 1,
                     .note = fmt::format("up to here the handle follows the rendered body within 3 "
                                         "dB, of {:g} Hz at most; along the worst axis",
                                         config.frequency_Hz.back())};
  bool has_all = true;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (!group.has_worked("transparency along " + name, axes[axis].failure)) {
      has_all = false;
      continue;
    }
    std::vector<double> frequency, following;
    Curve curve = {.id = "transparency", .name = name, .x_label = "frequency in Hz"};
    for (const Answer& answer : axes[axis].answers) {
      const std::complex<double> relative = answer.impedance / answer.twin;
      frequency.push_back(answer.frequency_Hz);
      following.push_back(std::abs(answer.following));
      curve.y["ratio"].push_back(std::abs(relative));
      curve.y["phase_deg"].push_back(degrees(relative));
      curve.y["felt_Ns_per_m"].push_back(std::abs(answer.impedance));
      curve.y["body_Ns_per_m"].push_back(std::abs(answer.twin));
      curve.y["following"].push_back(following.back());
      curve.y["following_phase_deg"].push_back(degrees(answer.following));
      table.rows.push_back(
          {name, amount(answer.frequency_Hz), amount(std::abs(answer.impedance)),
           amount(std::abs(answer.twin)), fmt::format("{:.3f}", std::abs(relative)),
           fmt::format("{:.1f}", degrees(relative)), fmt::format("{:.3f}", following.back()),
           fmt::format("{:.1f}", degrees(answer.following))});
    }
    if (frequency.empty()) continue;
    curve.x = frequency;
    group.out.curves.push_back(curve);
    keep_lowest(transparency_Hz(axes[axis]), felt);
    keep_lowest(bandwidth(frequency, following, kWithin3dB), position);
  }
  if (!has_all) felt.values = position.values = {};  // the worst axis may be the one that failed
  group.out.beyond.push_back(felt);
  group.out.beyond.push_back(position);
  group.out.tables.push_back(table);
}

void add_force_response(const Group& group) {
  ResponseConfig config = config_of(group.options);
  std::erase_if(config.frequency_Hz, [](double frequency) { return frequency < 0.5; });
  const auto axes = group.measure_all("force response", kAxes, [&](std::size_t i) {
    return measure_force_response(group.scenario, config, static_cast<int>(i), group.seed(0));
  });
  Table table = {
      .id = "force_response",
      .title = "Force at a hand that holds still over the commanded force",
      .note =
          "Reference wrench of the rendered body to and fro with 10 N along one axis "
          "of B, the stiff hand. Ideal: the same body in the same hand without a "
          "device between them.",
      .columns = {"axis", "frequency Hz", "rendered", "phase deg", "ideal", "phase deg"}};
  Figure figure = {.id = "force_bandwidth",
                   .name = "Force bandwidth",
                   .unit = "Hz",
                   .digits = 1,
                   .note =
                       "up to here the force at a stiff hand is within 3 dB of what the same "
                       "body without a device gives; along the worst axis of B"};
  Figure absolute = {.id = "force_bandwidth_absolute",
                     .name = "Force bandwidth of body and hand",
                     .unit = "Hz",
                     .digits = 1,
                     .note =
                         "up to here the force at that hand is within 3 dB of the commanded one: "
                         "the body's mass on the hand's spring swings"};
  bool has_all = true;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (!group.has_worked("force response along " + name, axes[axis].failure)) {
      has_all = false;
      continue;
    }
    std::vector<double> frequency, ratio, rendered;
    Curve curve = {.id = "force_response", .name = name, .x_label = "frequency in Hz"};
    for (const ForceAnswer& answer : axes[axis].answers) {
      frequency.push_back(answer.frequency_Hz);
      ratio.push_back(std::abs(answer.rendered / answer.ideal));
      rendered.push_back(std::abs(answer.rendered));
      curve.y["rendered"].push_back(rendered.back());
      curve.y["rendered_phase_deg"].push_back(degrees(answer.rendered));
      curve.y["ideal"].push_back(std::abs(answer.ideal));
      curve.y["ideal_phase_deg"].push_back(degrees(answer.ideal));
      table.rows.push_back({name, amount(answer.frequency_Hz),
                            fmt::format("{:.3f}", std::abs(answer.rendered)),
                            fmt::format("{:.1f}", degrees(answer.rendered)),
                            fmt::format("{:.3f}", std::abs(answer.ideal)),
                            fmt::format("{:.1f}", degrees(answer.ideal))});
    }
    if (frequency.empty()) continue;
    curve.x = frequency;
    group.out.curves.push_back(curve);
    keep_lowest(bandwidth(frequency, ratio, kWithin3dB), figure);
    keep_lowest(bandwidth(frequency, rendered, kWithin3dB), absolute);
  }
  if (!has_all) figure.values = absolute.values = {};
  group.out.beyond.push_back(figure);
  group.out.beyond.push_back(absolute);
  group.out.tables.push_back(table);
}

void add_latency(const Group& group) {
  const ResponseConfig config = config_of(group.options);
  const std::size_t n = group.repetitions();
  const auto all = group.measure_all("latency", kAxes * n, [&](std::size_t i) {
    return measure_latency(group.scenario, config, static_cast<int>(i / n), group.seed(i % n));
  });
  Figure motion = {.id = "latency",
                   .name = "Latency from wrench to motion",
                   .unit = "ms",
                   .note =
                       "by how much the handle's velocity after a step of 10 N is behind that "
                       "of the body itself; mean of three axes per repetition"};
  Figure rendered = motion;
  rendered.id = "latency_rendering";
  rendered.name = "of it until the rendered body moves";
  rendered.note = "sensor, its filter and the cycle; the rest is the torque loop";
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0, sensed = 0.0;
    bool has_all = true;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const Latency& one = all[axis * n + i];
      const std::string what = fmt::format("latency, axis {}, seed {}", axis, group.seed(i));
      has_all = group.has_worked(what, one.failure) && has_all;
      sum += one.motion_s;
      sensed += one.sensed_s;
    }
    if (!has_all) continue;
    motion.values.push_back(1e3 * sum / kAxes);
    rendered.values.push_back(1e3 * sensed / kAxes);
  }
  group.out.beyond.push_back(motion);
  group.out.beyond.push_back(rendered);
}

}  // namespace hg::haptify

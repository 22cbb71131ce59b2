// Where the acceleration that the device can give is felt: hard pulls, light rotations, stiff
// springs.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "hg/studies/changes.h"
#include "hg/studies/haptify/felt_body.h"
#include "hg/studies/haptify/groups.h"
#include "hg/studies/haptify/measures.h"
#include "hg/studies/haptify/response.h"
#include "hg/studies/haptify/swing.h"

namespace hg::haptify {
namespace {

using Values = std::vector<double>;

constexpr int kAxes = 3;

std::string mean_text(const Values& values, int digits) {
  return fmt::format("{:.{}f}", mean_value(values), digits);
}

// First corner of the transparency along the worst axis, Hz; what ended a run that was pushed too
// hard is a result.
std::string transparency(std::span<const Response> axes) {
  double lowest = kInfinity;
  for (const Response& axis : axes) {
    if (!axis.failure.empty()) return axis.failure;
    Values frequency, ratio;
    for (const Answer& answer : axis.answers) {
      frequency.push_back(answer.frequency_Hz);
      ratio.push_back(std::abs(answer.impedance / answer.twin));
    }
    lowest = std::min(lowest, bandwidth(frequency, ratio, kWithin3dB));
  }
  return fmt::format("{:.1f}", lowest);
}

}  // namespace

void add_felt_mass(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values forces = is_quick ? Values{20, 60} : Values{10, 20, 40, 60};
  const std::size_t n = group.repetitions();
  const auto pulls = group.measure_all("felt mass", forces.size() * kAxes * n, [&](std::size_t i) {
    return measure_pull(group.scenario, PullConfig(), static_cast<int>(i / n % kAxes),
                        forces[i / n / kAxes], group.seed(i % n));
  });
  ResponseConfig config;
  config.frequency_Hz = is_quick ? Values{1, 5, 20} : Values{0.5, 1, 2, 3, 5, 8, 12, 20};
  if (is_quick) {
    config.periods = 3;
    config.least_s = 0.6;
  }
  const auto responses =
      group.measure_all("transparency of hard pushes", forces.size() * kAxes, [&](std::size_t i) {
        ResponseConfig pushed = config;
        pushed.force = forces[i / kAxes];
        return measure_response(group.scenario, pushed, static_cast<int>(i % kAxes), group.seed(0));
      });
  const double mass = studies::free_twin_of(group.scenario).mass;
  Table table = {
      .id = "felt_mass",
      .title = "Felt mass",
      .note = fmt::format(
          "A steady force along one axis of the handle on the body of {:g} kg, without mass and "
          "spring of an arm: force over acceleration of the handle, mean of 0.05 to 0.25 s. And up "
          "to which frequency the impedance of pushes so hard to and fro stays within 3 dB of the "
          "body's, along the worst axis.",
          mass),
      .columns = {"N", "x kg", "y kg", "z kg", "worst over the body's", "transparent to Hz"}};
  for (std::size_t row = 0; row < forces.size(); ++row) {
    const double force = forces[row];
    table.rows.push_back({fmt::format("{:g}", force)});
    Values worst(n, 0.0);
    bool has_all = true;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      Values felt;
      for (std::size_t i = 0; i < n; ++i) {
        const Pull& one = pulls[(row * kAxes + axis) * n + i];
        const std::string what =
            fmt::format("felt mass, {:g} N along axis {}, seed {}", force, axis, group.seed(i));
        has_all = group.has_worked(what, one.failure) && has_all;
        felt.push_back(one.mass);
        worst[i] = std::max(worst[i], one.mass);
      }
      table.rows.back().push_back(has_all ? mean_text(felt, 2) : "failed");
    }
    table.rows.back().push_back(has_all ? fmt::format("{:.2f}", mean_value(worst) / mass)
                                        : "failed");
    table.rows.back().push_back(transparency(std::span(responses).subspan(row * kAxes, kAxes)));
    group.out.beyond.push_back({.id = fmt::format("felt_mass_{:g}", force),
                                .name = fmt::format("Felt mass under {:g} N", force),
                                .unit = "kg",
                                .values = has_all ? worst : Values{},
                                .note = fmt::format("of a body of {:g} kg, along the worst axis of "
                                                    "the handle",
                                                    mass)});
  }
  group.out.tables.push_back(table);
}

void add_rotation(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values inertia = is_quick ? Values{0.005, 0.02} : Values{0.001, 0.002, 0.003, 0.005, 0.007,
                                                                 0.01,  0.015, 0.02,  0.03,  0.05};
  std::vector<std::pair<std::string, person::HandPreset>> hands = {
      {"normal", person::HandPreset::kNormal}};
  if (!is_quick) {
    hands.insert(hands.begin(), {"relaxed", person::HandPreset::kRelaxed});
    hands.emplace_back("stiff", person::HandPreset::kStiff);
  }
  const TwistConfig config;
  const std::size_t columns = inertia.size();
  const auto all = group.measure_all("light rotations", hands.size() * columns, [&](std::size_t i) {
    return twist(group.scenario, config, person::hand(hands[i / columns].second),
                 inertia[i % columns]);
  });
  Table table = {
      .id = "rotation",
      .title = "Light rotations: which stay calm",
      .note = fmt::format(
          "A hand holds the body, whose handle is twisted with {:g} Nm for {:g} ms; calm is slower "
          "than {:g} rad/s after {:g} s. Columns: moment of inertia about every axis, kg m^2.",
          config.torque, 1e3 * config.duration, config.calm.calm_speed, 3.5 * config.calm.window),
      .columns = {"hand"}};
  for (const double value : inertia) table.columns.push_back(fmt::format("{:g}", value));
  double smallest = 0.0;  // value from which every hand comes to rest
  bool has_all = true;
  for (std::size_t hand = 0; hand < hands.size(); ++hand) {
    table.rows.push_back({hands[hand].first});
    double calm_from = kInfinity;
    for (std::size_t i = columns; i-- > 0;) {
      if (all[hand * columns + i].verdict != studies::DecayClass::kStable) break;
      calm_from = inertia[i];
    }
    smallest = std::max(smallest, calm_from);
    for (std::size_t i = 0; i < columns; ++i) {
      const Twist& one = all[hand * columns + i];
      const std::string what =
          fmt::format("rotation, {} hand, {:g} kg m^2", hands[hand].first, inertia[i]);
      const bool has_worked = group.has_worked(what, one.failure);
      has_all = has_all && has_worked;
      table.rows.back().emplace_back(has_worked ? to_string(one.verdict) : "failed");
    }
  }
  group.out.tables.push_back(table);
  group.out.beyond.push_back(
      {.id = "smallest_inertia",
       .name = "Smallest moment of inertia that is calm",
       .unit = "kg m^2",
       .digits = 3,
       .values = has_all && std::isfinite(smallest) ? Values{smallest} : Values{},
       .note = "of the table below, with every hand"});
}

void add_springs(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values stiffness = is_quick ? Values{500} : Values{50, 500, 2000};
  const Values deflection = is_quick ? Values{0.002} : Values{0.002, 0.02};  // m, of the handle
  SwingConfig config;
  if (is_quick) config.watched_s = 3.0;
  const std::size_t n = group.repetitions(), rows = stiffness.size() * deflection.size();
  const auto all = group.measure_all("springs", rows * n, [&](std::size_t i) {
    const std::size_t row = i / n;
    return measure_swing(group.scenario, config, stiffness[row / deflection.size()],
                         deflection[row % deflection.size()] / config.radius, group.seed(i % n));
  });
  Table table = {
      .id = "springs",
      .title = "Springs of a hinge",
      .note = fmt::format(
          "A hinge of {:g} kg m^2 and {:g} Nms/rad, {:g} m from the handle, that nobody holds, is "
          "let go beside the rest of its spring: the first {} swings of the true handle beside "
          "those of the hinge by itself. A damping ratio below 0 grows.",
          config.inertia, config.damping, config.radius, config.swings),
      .columns = {"Nm/rad", "let go at mm", "first swing mm", "ideal Hz", "Hz", "ratio",
                  "ideal damping ratio", "damping ratio"}};
  Values slowest(n, kInfinity);
  bool has_all = true;
  for (std::size_t row = 0; row < rows; ++row) {
    const double k = stiffness[row / deflection.size()];
    const double from = deflection[row % deflection.size()];
    Values frequency, damping, amplitude;
    for (std::size_t i = 0; i < n; ++i) {
      const Swing& one = all[row * n + i];
      const std::string what =
          fmt::format("spring of {:g} Nm/rad from {:g} mm, seed {}", k, 1e3 * from, group.seed(i));
      if (!group.has_worked(what, one.failure)) {
        has_all = false;
        continue;
      }
      frequency.push_back(one.true_handle.frequency_Hz);
      damping.push_back(one.true_handle.damping_ratio);
      amplitude.push_back(1e3 * config.radius * one.true_handle.amplitude);
      slowest[i] = std::min(slowest[i], frequency.back() / one.ideal_Hz);
    }
    if (frequency.empty()) continue;
    const Swing& ideal = all[row * n];
    table.rows.push_back({fmt::format("{:g}", k), fmt::format("{:g}", 1e3 * from),
                          mean_text(amplitude, 1), fmt::format("{:.2f}", ideal.ideal_Hz),
                          mean_text(frequency, 2),
                          fmt::format("{:.2f}", mean_value(frequency) / ideal.ideal_Hz),
                          fmt::format("{:.3f}", ideal.ideal_damping), mean_text(damping, 3)});
  }
  group.out.tables.push_back(table);
  group.out.beyond.push_back({.id = "spring_frequency",
                              .name = "Swing on a spring over its own frequency, lowest",
                              .values = has_all ? slowest : Values{},
                              .note = "of the springs below"});
}

}  // namespace hg::haptify

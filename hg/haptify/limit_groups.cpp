// Where the acceleration that the device can give is felt: impacts, hard pulls, light rotations,
// stiff springs.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "hg/experiments/changes.h"
#include "hg/haptify/felt_body.h"
#include "hg/haptify/groups.h"
#include "hg/haptify/impact.h"
#include "hg/haptify/measures.h"
#include "hg/haptify/response.h"
#include "hg/haptify/swing.h"

namespace hg::haptify {
namespace {

using Values = std::vector<double>;

constexpr int kAxes = 3;
constexpr double kWithin3dB = 1.4125;  // 3 dB

template <typename Item, typename Value>
Values values_of(const std::vector<Item>& items, const Value& value) {
  Values values;
  for (const Item& item : items) values.push_back(value(item));
  return values;
}

std::string mean_text(const Values& values, int digits) {
  return fmt::format("{:.{}f}", mean_value(values), digits);
}

// "1.9", or "never" where one of the repetitions goes on
std::string rest_text(const std::vector<Impact>& impacts) {
  const auto restless = std::ranges::count_if(
      impacts, [](const Impact& impact) { return std::isinf(impact.rest_s); });
  const auto count = static_cast<std::ptrdiff_t>(impacts.size());
  if (restless == count) return "never";
  if (restless > 0) return fmt::format("never in {} of {}", restless, count);
  return mean_text(values_of(impacts, [](const Impact& i) { return i.rest_s; }), 2);
}

// what ended the first of them that was ended
std::string end_text(const std::vector<Impact>& impacts) {
  const auto ended =
      std::ranges::find_if(impacts, [](const Impact& impact) { return !impact.end.empty(); });
  return ended == impacts.end() ? "" : ended->end;
}

std::vector<std::string> impact_row(double stiffness, const std::vector<Impact>& impacts) {
  const auto mean = [&](const auto& value, int digits) {
    return mean_text(values_of(impacts, value), digits);
  };
  return {fmt::format("{:g}", stiffness),
          mean([](const Impact& i) { return i.speed; }, 2),
          mean([](const Impact& i) { return 1e3 * i.depth; }, 1),
          mean([](const Impact& i) { return 1e3 * i.bound; }, 1),
          mean([](const Impact& i) { return i.depth / i.bound; }, 2),
          mean([](const Impact& i) { return i.rebound; }, 2),
          rest_text(impacts),
          mean([](const Impact& i) { return 1e3 * i.last_speed; }, 0),
          mean([](const Impact& i) { return 100.0 * i.energy_out / i.energy_in; }, 0),
          mean([](const Impact& i) { return i.peak_force; }, 0),
          mean([](const Impact& i) { return i.felt_force; }, 0),
          end_text(impacts)};
}

Table impact_table(const ImpactConfig& config, double braking) {
  return {.id = "impacts",
          .title = "Impacts on a wall",
          .note = fmt::format(
              "The scenario's hand, whose goal stops at an upright wall with {:g} Ns/m, runs into "
              "it. Speed just before it; deepest point of the handle in the first contact, and "
              "over v^2 / (2 a) with a = {:g} m/s^2, what device.yaml lets the handle brake with; "
              "speed at which it leaves the wall over that of the impact; when it is at rest "
              "(slower than {:g} mm/s for good, {:g} s watched) and its largest speed in the last "
              "{:g} s; what the wall gives back of the energy that it took, in all contacts; "
              "largest forces of wall and person.",
              config.damping, braking, 1e3 * config.rest_speed, config.watched_s, config.still_s),
          .columns = {"N/m", "m/s", "deepest mm", "v^2/(2a) mm", "ratio", "rebound", "rest s",
                      "last mm/s", "energy back %", "wall N", "person N", "ended by"}};
}

}  // namespace

void add_impacts(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values speeds = is_quick ? Values{0.4} : Values{0.2, 0.4, 0.83, 1.33};
  const Values stiffness = is_quick ? Values{2000} : Values{2000, 50000};
  ImpactConfig config;
  if (is_quick) config.watched_s = 4.5;
  const Values run_ups = group.measure_all("run-up", speeds.size(), [&](std::size_t i) {
    return find_run_up(group.scenario, config, speeds[i]);
  });
  const std::size_t n = group.repetitions(), rows = speeds.size() * stiffness.size();
  const auto all = group.measure_all("impacts", rows * n, [&](std::size_t i) {
    const std::size_t row = i / n;
    return measure_impact(group.scenario, config, stiffness[row / speeds.size()],
                          run_ups[row % speeds.size()], group.seed(i % n));
  });
  Table table = impact_table(config, braking_limit(group.scenario.device));
  Values ratio(n, 0.0), rebound(n, 0.0), restless(n, 0.0);
  bool has_all = true;
  for (std::size_t row = 0; row < rows; ++row) {
    const double k = stiffness[row / speeds.size()];
    std::vector<Impact> impacts;
    for (std::size_t i = 0; i < n; ++i) {
      const Impact& one = all[row * n + i];
      const std::string what = fmt::format("impact at {:g} m/s on {:g} N/m, seed {}",
                                           speeds[row % speeds.size()], k, group.seed(i));
      if (!group.has_worked(what, one.failure)) {
        has_all = false;
        continue;
      }
      impacts.push_back(one);
      ratio[i] = std::max(ratio[i], one.depth / one.bound);
      rebound[i] = std::max(rebound[i], one.rebound);
      restless[i] += std::isinf(one.rest_s) ? 1.0 : 0.0;
    }
    if (!impacts.empty()) table.rows.push_back(impact_row(k, impacts));
  }
  group.out.tables.push_back(table);
  if (!has_all) ratio = rebound = restless = {};
  group.out.beyond.push_back({.id = "impact_depth",
                              .name = "Depth of an impact over v^2 / (2 a), largest",
                              .values = ratio,
                              .note = "of the impacts below; 1 is braking as hard as allowed"});
  group.out.beyond.push_back({.id = "impact_rebound",
                              .name = "Speed after an impact over that before, largest",
                              .values = rebound,
                              .note = "1: the wall is a perfect spring, above it drives the body"});
  group.out.beyond.push_back({.id = "impact_restless",
                              .name = "Impacts that do not come to rest",
                              .digits = 1,
                              .values = restless,
                              .note = fmt::format("of {} within {:g} s", rows, config.watched_s)});
}

namespace {

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
  const double mass = experiments::free_twin_of(group.scenario).mass;
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
  std::vector<std::pair<std::string, user::HandPreset>> hands = {
      {"normal", user::HandPreset::kNormal}};
  if (!is_quick) {
    hands.insert(hands.begin(), {"relaxed", user::HandPreset::kRelaxed});
    hands.emplace_back("stiff", user::HandPreset::kStiff);
  }
  const TwistConfig config;
  const std::size_t columns = inertia.size();
  const auto all = group.measure_all("light rotations", hands.size() * columns, [&](std::size_t i) {
    return twist(group.scenario, config, user::hand(hands[i / columns].second),
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
  double smallest = 0.0;  // from which on every hand is calm
  bool has_all = true;
  for (std::size_t hand = 0; hand < hands.size(); ++hand) {
    table.rows.push_back({hands[hand].first});
    double calm_from = kInfinity;
    for (std::size_t i = columns; i-- > 0;) {
      if (all[hand * columns + i].verdict != experiments::Verdict::kStable) break;
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

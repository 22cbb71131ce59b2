#include "hg/experiments/haptify/response.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/measures.h"
#include "hg/experiments/haptify/play.h"
#include "hg/experiments/player.h"

namespace hg::haptify {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;
constexpr double kPause = 1.0;  // s, before everything

// A whole number of periods that count, after some for the transient; s after the grasp.
struct Spell {
  double frequency_Hz = 0.0, begin_s = 0.0, end_s = 0.0;
};

struct Sweep {
  std::vector<Spell> spells;
  double end_s = 0.0;
};

Sweep sweep(const ResponseConfig& config) {
  Sweep result;
  double time = kPause;
  for (const double frequency : config.frequency_Hz) {
    const double counted =
        std::max(config.periods, static_cast<int>(std::ceil(config.least_s * frequency))) /
        frequency;
    const double before = std::max(1.0, std::ceil(0.3 * frequency)) / frequency;
    result.spells.push_back({frequency, time + before, time + before + counted});
    time += before + counted + 0.5;
  }
  result.end_s = time + 0.1;
  return result;
}

double start_of(const Spell& spell) {
  return spell.begin_s - std::max(1.0, std::ceil(0.3 * spell.frequency_Hz)) / spell.frequency_Hz;
}

std::span<const Instant> part(const Played& played, double begin_s, double end_s, double rate_Hz) {
  const auto at = [&](double time) {
    return std::min(played.instants.size(), static_cast<std::size_t>(std::llround(time * rate_Hz)));
  };
  return std::span(played.instants).subspan(at(begin_s), at(end_s) - at(begin_s));
}

Complex amplitude_of(std::span<const Instant> instants, double frequency_Hz, double rate_Hz,
                     const std::function<double(const Instant&)>& value) {
  std::vector<double> values;
  for (const Instant& now : instants) values.push_back(value(now));
  return amplitude(values, frequency_Hz, rate_Hz);
}

// Ramps of half a period are nearly a sine.
person::Script pushes(const ResponseConfig& config, const Sweep& plan, int axis) {
  person::Script script;
  const int channel = person::kWrenchChannel + axis;
  for (const Spell& spell : plan.spells) {
    const double half = 0.5 / spell.frequency_Hz;
    double value = config.force;
    double time = start_of(spell);
    for (; time < spell.end_s - 0.5 * half; time += half) {
      script.segments.push_back(
          {.start_s = time, .duration_s = half, .channel = channel, .value = value});
      value = -value;
    }
    script.segments.push_back(
        {.start_s = spell.end_s, .duration_s = 0.25, .channel = channel, .value = 0.0});
  }
  script.duration_s = plan.end_s;
  return script;
}

}  // namespace

config::Scenario instrument(const config::Scenario& scenario, const ResponseConfig& config,
                            const person::Script& script, std::uint64_t seed) {
  config::Scenario result = with_script(scenario, script);
  result.twin.model.q_start.head<3>() = config.position;
  experiments::set_seed(result, seed);
  return result;
}

double transparency_Hz(const Response& response) {
  std::vector<double> frequency, ratio;
  for (const Answer& answer : response.answers) {
    frequency.push_back(answer.frequency_Hz);
    ratio.push_back(std::abs(answer.impedance / answer.twin));
  }
  return bandwidth(frequency, ratio, kWithin3dB);
}

Response measure_response(const config::Scenario& scenario, const ResponseConfig& config, int axis,
                          std::uint64_t seed) {
  const experiments::FreeTwin twin = experiments::free_twin_of(scenario);
  const Sweep plan = sweep(config);
  const config::Scenario pushed = instrument(scenario, config, pushes(config, plan, axis), seed);
  const Played played = play(pushed);
  Response result = {.failure = played.failure};
  if (!played.failure.empty() || played.instants.empty()) return result;
  const double rate_Hz = pushed.device.model.rate_Hz;
  const Eigen::Vector3d direction = played.instants.front().T_B_H.R.col(axis);
  for (const Spell& spell : plan.spells) {
    const auto counted = part(played, spell.begin_s, spell.end_s, rate_Hz);
    const auto of = [&](const std::function<double(const Instant&)>& value) {
      return amplitude_of(counted, spell.frequency_Hz, rate_Hz, value);
    };
    const Complex v = of([&](const Instant& now) { return direction.dot(now.twist.head<3>()); });
    const Complex f = of([&](const Instant& now) { return direction.dot(now.w_H.head<3>()); });
    const Complex p = of([&](const Instant& now) { return direction.dot(now.T_B_H.p); });
    const Complex e = of([&](const Instant& now) { return direction.dot(now.p_B_E); });
    result.answers.push_back({.frequency_Hz = spell.frequency_Hz,
                              .impedance = f / v,
                              .twin = {twin.damping, 2.0 * kPi * spell.frequency_Hz * twin.mass},
                              .following = p / e});
  }
  return result;
}

namespace {

// A wrench of the twin changes as a lag of 0.1 s behind its target (rendering/twin_parameters.h):
// targets that make the wrench itself a sine.
std::vector<TimedChange> reference_force(const ResponseConfig& config, const Sweep& plan,
                                         int component, double grasp_s, double rate_Hz) {
  constexpr double kLag = 0.1;  // s
  std::vector<TimedChange> changes;
  for (const Spell& spell : plan.spells) {
    const double omega = 2.0 * kPi * spell.frequency_Hz;
    const double begin_s = start_of(spell);
    const auto count = static_cast<int>(std::llround((spell.end_s - begin_s) * rate_Hz));
    for (int i = 0; i <= count; ++i) {
      const double t = i / rate_Hz;
      const double target =
          i < count ? config.force * (std::sin(omega * t) + kLag * omega * std::cos(omega * t))
                    : 0.0;
      changes.push_back({.at_s = grasp_s + begin_s + t,
                         .change = {.parameter = Parameter::kReferenceWrench,
                                    .index = static_cast<std::int16_t>(component),
                                    .value = target}});
    }
  }
  return changes;
}

// Impedance of the hand at the handle along one of the person's axes: grip and arm in series.
Complex hand_impedance(const person::HandImpedance& hand, int axis, double omega) {
  const Complex s = {0.0, omega};
  const Complex grip = hand.grip_damping + hand.grip_stiffness / s;
  const Complex arm = hand.mass[axis] * s + hand.damping[axis] + hand.stiffness[axis] / s;
  return 1.0 / (1.0 / grip + 1.0 / arm);
}

}  // namespace

ForceResponse measure_force_response(const config::Scenario& scenario, const ResponseConfig& config,
                                     int axis, std::uint64_t seed) {
  const experiments::FreeTwin twin = experiments::free_twin_of(scenario);
  const Sweep plan = sweep(config);
  person::Script script;
  script.duration_s = plan.end_s;
  config::Scenario driven = instrument(scenario, config, script, seed);
  driven.script.hand = person::hand(person::HandPreset::kStiff);
  driven.script.hand.tremor_rms = 0.0;
  const double rate_Hz = driven.device.model.rate_Hz;
  driven.changes = reference_force(config, plan, axis, driven.script.script.grasp_s, rate_Hz);
  const Played played = play(driven);
  ForceResponse result = {.failure = played.failure};
  if (!played.failure.empty() || played.instants.empty()) return result;
  // the person stands along the heading of the handle: pi / 2 turns fore-aft into y of B
  const config::HandPose pose = config::hand_of(played.instants.front().T_B_H);
  const Eigen::Vector3d in_person =
      Eigen::AngleAxisd(-pose.azimuth, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d::Unit(axis);
  Eigen::Index person_axis = 0;
  in_person.cwiseAbs().maxCoeff(&person_axis);
  for (const Spell& spell : plan.spells) {
    const double omega = 2.0 * kPi * spell.frequency_Hz;
    const auto counted = part(played, spell.begin_s, spell.end_s, rate_Hz);
    const Complex f = amplitude_of(counted, spell.frequency_Hz, rate_Hz,
                                   [&](const Instant& now) { return now.w_H[axis]; });
    const Complex commanded =
        amplitude_of(counted, spell.frequency_Hz, rate_Hz, [&](const Instant& now) {
          return config.force * std::sin(omega * (now.time_s - start_of(spell)));
        });
    const Complex hand = hand_impedance(driven.script.hand, static_cast<int>(person_axis), omega);
    const Complex body = {twin.damping, omega * twin.mass};
    result.answers.push_back({.frequency_Hz = spell.frequency_Hz,
                              .rendered = f / commanded,
                              .ideal = hand / (hand + body)});
  }
  return result;
}

Latency measure_latency(const config::Scenario& scenario, const ResponseConfig& config, int axis,
                        std::uint64_t seed) {
  constexpr double kMost = 0.05;  // s: no device is that slow
  const experiments::FreeTwin twin = experiments::free_twin_of(scenario);
  person::Script script;
  script.segments.push_back({.start_s = kPause + 0.5,
                             .duration_s = 1e-4,
                             .channel = person::kWrenchChannel + axis,
                             .value = config.step_force});
  script.duration_s = kPause + 0.5 + config.watched_s;
  const config::Scenario pushed = instrument(scenario, config, script, seed);
  const double rate_Hz = pushed.device.model.rate_Hz;
  const Played played = play(pushed);
  Latency result = {.failure = played.failure};
  if (!played.failure.empty() || played.instants.empty()) return result;
  const Eigen::Vector3d direction = played.instants.front().T_B_H.R.col(axis);
  const auto watched = part(played, kPause + 0.5 - kMost - 0.01, script.duration_s, rate_Hz);
  std::vector<double> ideal, handle, rendered;
  double v = direction.dot(watched.front().twist.head<3>());
  Eigen::Vector3d last = watched.front().p_B_E;
  for (const Instant& now : watched) {
    ideal.push_back(v);
    handle.push_back(direction.dot(now.twist.head<3>()));
    rendered.push_back(direction.dot(now.p_B_E - last) * rate_Hz);
    last = now.p_B_E;
    v += (direction.dot(now.w_H.head<3>()) - twin.damping * v) / twin.mass / rate_Hz;
  }
  result.motion_s = delay(ideal, handle, rate_Hz, kMost);
  result.sensed_s = delay(ideal, rendered, rate_Hz, kMost);
  return result;
}

}  // namespace hg::haptify

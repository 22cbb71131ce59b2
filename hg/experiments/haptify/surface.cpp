#include "hg/experiments/haptify/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/measures.h"
#include "hg/experiments/player.h"
#include "hg/experiments/stability_map.h"

namespace hg::haptify {
namespace {

constexpr int kHeight = 2;     // channel of a script in the base frame
constexpr double kRest = 1.0;  // s, before everything

person::Segment move(double start_s, double duration_s, int channel, double by) {
  return {.start_s = start_s,
          .duration_s = duration_s,
          .channel = channel,
          .blend = person::Blend::kBy,
          .value = by};
}

// Depth of the hand's goal below the surface for a pressing force: arm, grip and surface deflect.
double aim(const person::HandImpedance& hand, double stiffness, double clearance, double force) {
  return clearance +
         force * (1.0 / hand.stiffness.z() + 1.0 / hand.grip_stiffness + 1.0 / stiffness);
}

// Strong enough to press harder than the device can: an arm that leans on it.
person::HandImpedance leaning_hand() {
  person::HandImpedance hand = person::hand(person::HandPreset::kStiff);
  hand.stiffness.setConstant(2000.0);
  hand.damping.setConstant(120.0);
  hand.force_max = 400.0;
  return hand;
}

config::Scenario with_hand(config::Scenario scenario, const person::HandImpedance& hand,
                           const person::Script& script) {
  scenario.script.hand = hand;
  return with_script(std::move(scenario), script);
}

// Normal force over depth of the true handle, from the begin of the contact to the largest force.
struct Loading {
  std::vector<double> depth, twin_depth, force;
};

Loading loading_of(const Played& played, double surface_z, double least_force) {
  Loading loading;
  std::size_t top = 0;
  for (std::size_t i = 0; i < played.instants.size(); ++i) {
    if (played.instants[i].w_H.z() < played.instants[top].w_H.z()) top = i;
  }
  for (std::size_t i = 0; i <= top && i < played.instants.size(); ++i) {
    const Instant& now = played.instants[i];
    if (now.time_s < kRest || now.T_B_H.p.z() > surface_z || -now.w_H.z() < least_force) continue;
    loading.depth.push_back(surface_z - now.T_B_H.p.z());
    loading.twin_depth.push_back(surface_z - now.p_B_E.z());
    loading.force.push_back(-now.w_H.z());
  }
  return loading;
}

}  // namespace

config::Scenario above_surface(const config::Scenario& scenario, const SurfaceConfig& config,
                               double stiffness, double damping) {
  config::Scenario above = scenario;
  above.surfaces = {surfaces::Surface{.name = "plane",
                                      .shape = surfaces::Plane{},
                                      .pose = {.p = config.position},
                                      .stiffness = stiffness,
                                      .damping = damping}};
  above.twin.model.q_start.head<3>() =
      config.position + config.clearance * Eigen::Vector3d::UnitZ();
  return above;
}

Slide measure_slide(const config::Scenario& scenario, const SurfaceConfig& config,
                    std::uint64_t seed) {
  const experiments::FreeTwin twin = experiments::free_twin_of(scenario);
  const double k = config.slide_stiffness;
  person::Script script;
  const double down = aim(scenario.script.hand, k, config.clearance, config.slide_force);
  script.segments.push_back(move(kRest, 1.0, kHeight, -down));
  double time = kRest + 2.0;
  const double begin_s = time;
  for (int axis = 0; axis < 2; ++axis) {
    for (int i = 0; i < config.strokes; ++i) {
      script.segments.push_back(
          move(time, config.stroke_s, axis, i % 2 == 0 ? config.stroke : -config.stroke));
      time += config.stroke_s;
    }
  }
  script.duration_s = time;
  config::Scenario sliding =
      with_script(above_surface(scenario, config, k, config.damping), script);
  experiments::set_seed(sliding, seed);
  const Played played = play(sliding);
  Slide result = {.failure = played.failure};
  double count = 0.0;
  for (const Instant& now : played.instants) {
    if (now.time_s < begin_s || now.T_B_H.p.z() > config.position.z()) continue;
    const Eigen::Vector2d own =
        twin.mass * now.acceleration.head<2>() + twin.damping * now.twist.head<2>();
    result.force += now.w_H.head<2>().norm();
    result.own_share += own.norm();
    result.inertial += twin.mass * now.acceleration.head<2>().norm();
    result.viscous += twin.damping * now.twist.head<2>().norm();
    result.extra += (now.w_H.head<2>() - own).norm();
    result.normal -= now.w_H.z();
    result.speed += now.twist.head<2>().norm();
    count += 1.0;
  }
  if (count == 0.0) {
    if (result.failure.empty()) result.failure = "the hand did not touch the surface";
    return result;
  }
  for (double* sum : {&result.force, &result.own_share, &result.inertial, &result.viscous,
                      &result.extra, &result.normal, &result.speed}) {
    *sum /= count;
  }
  return result;
}

Press measure_press(const config::Scenario& scenario, const SurfaceConfig& config, double stiffness,
                    std::uint64_t seed) {
  person::HandImpedance hand = person::hand(person::HandPreset::kStiff);
  hand.force_max = 2.0 * config.press_force;
  const double down = aim(hand, stiffness, config.clearance, config.press_force);
  person::Script script;
  script.segments.push_back(move(kRest, config.press_s, kHeight, -down));
  script.segments.push_back(move(kRest + config.press_s + 0.5, config.press_s, kHeight, down));
  script.duration_s = kRest + 2.0 * config.press_s + 1.0;
  config::Scenario pressed =
      with_hand(above_surface(scenario, config, stiffness, config.damping), hand, script);
  experiments::set_seed(pressed, seed);
  const Played played = play(pressed);
  Press result = {.failure = played.failure};
  const Loading loading = loading_of(played, config.position.z(), config.least_force);
  if (loading.force.size() < 100) {
    if (result.failure.empty()) result.failure = "the hand did not press on the surface";
    return result;
  }
  result.accuracy = 100.0 * fit_line(loading.depth, loading.force).slope / stiffness;
  result.twin_accuracy = 100.0 * fit_line(loading.twin_depth, loading.force).slope / stiffness;
  result.force = loading.force.back();
  return result;
}

Peak measure_peak(const config::Scenario& scenario, const SurfaceConfig& config,
                  std::uint64_t seed) {
  const person::HandImpedance hand = leaning_hand();
  const double k = config.peak_stiffness;
  person::Script script;
  script.segments.push_back(
      move(kRest, config.peak_s, kHeight, -aim(hand, k, config.clearance, config.peak_force)));
  script.duration_s = kRest + config.peak_s + 1.0;
  config::Scenario pressed =
      with_hand(above_surface(scenario, config, k, config.damping), hand, script);
  experiments::set_seed(pressed, seed);
  const Played played = play(pressed);
  Peak result;
  const Loading loading = loading_of(played, config.position.z(), config.least_force);
  // means of a quarter of a second: what mass and damping of the body add swings around the line
  const std::size_t block = std::llround(0.25 * pressed.device.model.rate_Hz);
  for (std::size_t begin = 0; begin + block <= loading.force.size(); begin += block) {
    double force = 0.0, line = 0.0;
    for (std::size_t i = begin; i < begin + block; ++i) {
      force += loading.force[i] / static_cast<double>(block);
      line += k * loading.depth[i] / static_cast<double>(block);
    }
    if (force > 20.0 && std::abs(force - line) > config.peak_tolerance * line) {
      result.end = fmt::format("farther than {:g} % from the line", 100.0 * config.peak_tolerance);
      break;
    }
    result.force = std::max(result.force, force);
  }
  if (result.end.empty()) {
    result.end = played.failure.empty() ? "the person pressed no harder" : played.failure;
  }
  if (loading.force.size() < 100) result.failure = "the hand did not press on the surface";
  return result;
}

Knock knock(const config::Scenario& scenario, const SurfaceConfig& config, double stiffness,
            double damping) {
  const experiments::Kick kick;
  person::HandImpedance hand = person::hand(config.knock_hand);
  hand.tremor_rms = 0.0;
  const double down = aim(hand, stiffness, config.clearance, config.knock_press);
  const double kick_s = kRest + 2.0, watched_s = 3.5 * config.calm.window;
  person::Script script;
  script.segments.push_back(move(kRest, 1.0, kHeight, -down));
  add_kick(kick, kick_s, script);
  script.duration_s = kick_s + kick.duration + watched_s;
  config::Scenario knocked =
      with_hand(above_surface(scenario, config, stiffness, damping), hand, script);
  knocked.device.passivity.reaction = passivity::Reaction::kOff;
  const Played played = play(knocked);
  std::vector<double> speed;
  bool has_touched = false;
  for (const Instant& now : played.instants) {
    if (now.time_s >= kick_s + kick.duration) speed.push_back(std::abs(now.twist.z()));
    has_touched = has_touched || (now.time_s < kick_s && now.p_B_E.z() < config.position.z());
  }
  if (!has_touched) {
    return {.failure =
                played.failure.empty() ? "the hand did not touch the surface" : played.failure};
  }
  if (!played.failure.empty()) return {.verdict = experiments::DecayClass::kDiverges};
  return {.verdict = experiments::judge_decay(speed, config.calm, knocked.device.model.rate_Hz)};
}

}  // namespace hg::haptify

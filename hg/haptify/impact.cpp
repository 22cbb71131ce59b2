#include "hg/haptify/impact.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "hg/environment/surface.h"
#include "hg/experiments/player.h"
#include "hg/haptify/play.h"

namespace hg::haptify {
namespace {

constexpr int kAhead = 1;      // y of B: straight ahead of the person, who looks along it
constexpr double kRest = 1.0;  // s, before everything

config::Scenario prepared(const config::Scenario& scenario, const ImpactConfig& config,
                          double stiffness, double run_up, double watched_s, std::uint64_t seed) {
  user::Script script;
  script.segments.push_back({.start_s = kRest,
                             .duration_s = config.run_up_s,
                             .channel = kAhead,
                             .blend = user::Blend::kBy,
                             .value = run_up});
  script.duration_s = kRest + config.run_up_s + watched_s;
  config::Scenario result = with_script(scenario, script);
  result.twin.model.q_start.head<3>() = config.position - run_up * Eigen::Vector3d::Unit(kAhead);
  const Eigen::AngleAxisd towards_hand(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX());
  result.surfaces = {
      environment::Surface{.name = "wall",
                           .shape = environment::Plane{},
                           .pose = {.p = config.position, .R = towards_hand.toRotationMatrix()},
                           .stiffness = stiffness,
                           .damping = config.damping}};
  experiments::set_seed(result, seed);
  return result;
}

// The sample in which the handle first is behind the wall; all of them when it never is.
std::size_t contact_of(const Played& played, const ImpactConfig& config) {
  const auto at = std::ranges::find_if(played.instants, [&](const Instant& now) {
    return now.T_B_H.p[kAhead] > config.position[kAhead];
  });
  return static_cast<std::size_t>(at - played.instants.begin());
}

}  // namespace

double braking_limit(const config::Device& device) {
  return rendering::handle_limits(device.model)[kAhead].ddq_max;
}

double find_run_up(const config::Scenario& scenario, const ImpactConfig& config, double speed) {
  constexpr int kTries = 9;         // of halving: 3 mm
  constexpr double kLongest = 2.0;  // s from the end of the goal's way to the wall
  double too_short = 0.0, enough = config.longest_run_up;
  for (int i = 0; i < kTries; ++i) {
    const double run_up = 0.5 * (too_short + enough);
    config::Scenario tried = prepared(scenario, config, 1.0, run_up, kLongest, 1);
    tried.surfaces.clear();
    const Played played = play(tried);
    const std::size_t contact = contact_of(played, config);
    const bool is_fast =
        contact < played.instants.size() && played.instants[contact].twist[kAhead] >= speed;
    (is_fast ? enough : too_short) = run_up;
  }
  return enough;
}

Impact measure_impact(const config::Scenario& scenario, const ImpactConfig& config,
                      double stiffness, double run_up, std::uint64_t seed) {
  const config::Scenario hit =
      prepared(scenario, config, stiffness, run_up, config.watched_s + 1.0, seed);
  const Played played = play(hit);
  const std::vector<Instant>& all = played.instants;
  const std::size_t contact = contact_of(played, config);
  Impact result = {.end = played.failure};
  if (contact == 0 || contact >= all.size()) {
    result.failure = played.failure.empty() ? "the hand did not reach the wall" : played.failure;
    return result;
  }
  result.speed = all[contact - 1].twist[kAhead];
  const double a = braking_limit(hit.device);
  if (std::isfinite(a)) result.bound = result.speed * result.speed / (2.0 * a);
  const double contact_s = all[contact].time_s;
  const double end_s = std::min(all.back().time_s, contact_s + config.watched_s);
  double last_fast_s = contact_s;
  double back = 0.0;
  bool has_left = false;  // the wall, for the first time
  for (std::size_t i = contact; i < all.size() && all[i].time_s <= end_s; ++i) {
    const Instant& now = all[i];
    const double v = now.twist[kAhead];
    const double depth = now.T_B_H.p[kAhead] - config.position[kAhead];
    if (depth < 0.0) has_left = true;
    if (!has_left) {
      result.depth = std::max(result.depth, depth);
      back = std::max(back, -v);
    }
    if (std::abs(v) > config.rest_speed) last_fast_s = now.time_s;
    if (now.time_s > end_s - config.still_s) {
      result.last_speed = std::max(result.last_speed, std::abs(v));
    }
    result.peak_force = std::max(result.peak_force, now.surface.norm());
    result.felt_force = std::max(result.felt_force, std::abs(now.w_H[kAhead]));
    if (i + 1 == all.size()) break;
    const double work = now.surface.dot(all[i + 1].p_B_E - now.p_B_E);
    (work < 0.0 ? result.energy_in : result.energy_out) += std::abs(work);
  }
  result.rebound = result.speed > 0.0 ? back / result.speed : 0.0;
  const bool rests = last_fast_s <= end_s - config.still_s && result.end.empty();
  result.rest_s = rests ? last_fast_s - contact_s : kInfinity;
  return result;
}

}  // namespace hg::haptify

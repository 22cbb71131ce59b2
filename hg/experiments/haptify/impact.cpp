#include "hg/experiments/haptify/impact.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "hg/controller/rendering/braking.h"
#include "hg/controller/rendering/motor_torque.h"
#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/play.h"
#include "hg/experiments/player.h"

namespace hg::haptify {
namespace {

constexpr int kAhead = 1;             // y of B: straight ahead of the person, who looks along it
constexpr double kRest = 1.0;         // s, before everything
constexpr double kFastest = 0.01;     // s, of the way of a goal
constexpr double kFastEnough = 0.95;  // share of the requested speed that is fast enough

config::Scenario prepared(const config::Scenario& scenario, const ImpactConfig& config,
                          double stiffness, double speed, double way_s, double watched_s,
                          std::uint64_t seed) {
  const auto [run_up, behind] = way_of_impact(scenario, config, speed);
  person::Script script;
  script.segments.push_back({.start_s = kRest,
                             .duration_s = way_s,
                             .channel = kAhead,
                             .blend = person::Blend::kBy,
                             .value = run_up + behind});
  script.duration_s = kRest + way_s + watched_s;
  config::Scenario result = with_script(scenario, script);
  result.twin.model.q_start.head<3>() = config.position - run_up * Eigen::Vector3d::Unit(kAhead);
  const Eigen::AngleAxisd towards_hand(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX());
  result.surfaces = {
      surfaces::Surface{.name = "wall",
                        .shape = surfaces::Plane{},
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
  return at - played.instants.begin();
}

// From the contact to the deepest point.
double braking_of(const DeviceModel& device, std::span<const Instant> braking) {
  const Instant& first = braking.front();
  rendering::DeviceMotion motion = {first.q_p, first.dq_p, first.q_m, first.dq_m};
  for (const Instant& now : braking) motion.w_H += now.w_H / static_cast<double>(braking.size());
  return rendering::largest_acceleration(device, motion, -Eigen::Vector3d::Unit(kAhead));
}

}  // namespace

ImpactWay way_of_impact(const config::Scenario& scenario, const ImpactConfig& config,
                        double speed) {
  return {.run_up = config.run_up_s * speed,
          .behind = config.press / scenario.script.hand.stiffness[kAhead] +
                    kDeepestImpact * speed * speed / (2.0 * config.braking)};
}

double find_way(const config::Scenario& scenario, const ImpactConfig& config, double speed) {
  constexpr int kTries = 9;  // number of bisection steps
  double fast = 0.0, slow = config.longest_way_s;
  for (int i = 0; i < kTries; ++i) {
    const double way_s = 0.5 * (fast + slow);
    config::Scenario tried = prepared(scenario, config, 1.0, speed, way_s, 1.0, 1);
    tried.surfaces.clear();
    const Played played = play(tried);
    const std::size_t contact = contact_of(played, config);
    const bool is_fast =
        contact < played.instants.size() && played.instants[contact].twist[kAhead] >= speed;
    (is_fast ? fast : slow) = way_s;
  }
  return std::max(fast, kFastest);
}

Impact measure_impact(const config::Scenario& scenario, const ImpactConfig& config,
                      double stiffness, double speed, double way_s, std::uint64_t seed) {
  const config::Scenario hit =
      prepared(scenario, config, stiffness, speed, way_s, config.watched_s + 1.0, seed);
  const double mass = experiments::free_twin_of(hit).mass;
  const Played played = play(hit);
  const std::vector<Instant>& all = played.instants;
  const std::size_t contact = contact_of(played, config);
  Impact result = {.end = played.failure};
  if (contact == 0 || contact >= all.size()) {
    result.failure = played.failure.empty() ? "the hand did not reach the wall" : played.failure;
    return result;
  }
  result.speed = all[contact - 1].twist[kAhead];
  if (result.speed < kFastEnough * speed) {
    result.failure = kTooSlow;
    return result;
  }
  const double contact_s = all[contact].time_s;
  const double end_s = std::min(all.back().time_s, contact_s + config.watched_s);
  double last_fast_s = contact_s;
  double back = 0.0;
  std::size_t deepest = contact;
  bool has_left = false;  // the wall, for the first time
  for (std::size_t i = contact; i < all.size() && all[i].time_s <= end_s; ++i) {
    const Instant& now = all[i];
    const double v = now.twist[kAhead];
    const double depth = now.T_B_H.p[kAhead] - config.position[kAhead];
    if (depth < 0.0) has_left = true;
    if (!has_left) {
      if (depth > result.depth) deepest = i;
      result.depth = std::max(result.depth, depth);
      back = std::max(back, -v);
    }
    if (std::abs(v) > config.rest_speed) last_fast_s = now.time_s;
    if (now.time_s > end_s - config.still_s) {
      result.last_speed = std::max(result.last_speed, std::abs(v));
    }
    result.peak_force = std::max(result.peak_force, now.surface.norm());
    result.felt_force = std::max(result.felt_force, std::abs(now.w_H[kAhead]));
    const double work = now.contact_power / hit.device.model.rate_Hz;
    (work < 0.0 ? result.energy_in : result.energy_out) += std::abs(work);
  }
  result.braking =
      braking_of(hit.device.model, std::span(all).subspan(contact, deepest + 1 - contact));
  if (result.braking <= 0.0) {
    result.failure = "the motors cannot hold the handle";
    return result;
  }
  result.bound = result.speed * result.speed / (2.0 * result.braking);
  result.onset = 0.5 * rendering::kTorqueOnset * result.speed;
  const double moved = mass + hit.script.hand.mass[kAhead];
  result.spring =
      result.felt_force / stiffness + result.speed * std::sqrt(moved / stiffness) / std::numbers::e;
  result.rebound = result.speed > 0.0 ? back / result.speed : 0.0;
  const bool rests = last_fast_s <= end_s - config.still_s && result.end.empty();
  result.rest_s = rests ? last_fast_s - contact_s : kInfinity;
  return result;
}

}  // namespace hg::haptify

#include "hg/experiments/haptify/felt_body.h"

#include <algorithm>
#include <cmath>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/play.h"
#include "hg/experiments/player.h"

namespace hg::haptify {
namespace {

constexpr double kEdge = 1e-4;  // s: less than a step of the plant

// on and off
void add_push(person::Script& script, int channel, double value, double begin_s, double rise_s,
              double end_s) {
  script.segments.push_back(
      {.start_s = begin_s, .duration_s = rise_s, .channel = channel, .value = value});
  script.segments.push_back(
      {.start_s = end_s, .duration_s = rise_s, .channel = channel, .value = 0.0});
}

}  // namespace

Pull measure_pull(const config::Scenario& scenario, const PullConfig& config, int axis,
                  double force, std::uint64_t seed) {
  constexpr double kBegin = 1.0;  // s
  person::Script script;
  add_push(script, person::kWrenchChannel + axis, force, kBegin, config.rise_s,
           kBegin + config.to_s);
  script.duration_s = kBegin + config.to_s;
  config::Scenario pulled = with_script(scenario, script);
  pulled.script.script.start[person::kGripChannel] = 0.0;
  pulled.twin.model.q_start.head<3>() = config.position;
  experiments::set_seed(pulled, seed);
  const Played played = play(pulled);
  Pull result = {.failure = played.failure};
  if (!played.failure.empty()) return result;
  const Eigen::Vector3d direction = played.instants.front().T_B_H.R.col(axis);
  double f = 0.0, a = 0.0, count = 0.0;
  for (const Instant& now : played.instants) {
    if (now.time_s < kBegin + config.from_s || now.time_s > kBegin + config.to_s) continue;
    f += direction.dot(now.w_H.head<3>());
    a += direction.dot(now.acceleration.head<3>());
    count += 1.0;
  }
  result.acceleration = a / count;
  result.mass = f / a;
  return result;
}

Twist twist(const config::Scenario& scenario, const TwistConfig& config,
            const person::HandImpedance& hand, double inertia) {
  const double end_s = config.settling_s + config.duration;
  person::Script script;
  for (int axis = 3; axis < 6; ++axis) {
    add_push(script, person::kWrenchChannel + axis, config.torque / std::sqrt(3.0),
             config.settling_s, kEdge, end_s);
  }
  std::ranges::stable_sort(script.segments, {}, &person::Segment::start_s);
  script.duration_s = end_s + 3.5 * config.calm.window;
  config::Scenario kicked = with_script(scenario, script);
  kicked.twin.model.q_start.head<3>() = config.position;
  experiments::set_free_inertia(kicked, inertia);
  kicked.script.hand = hand;
  kicked.script.hand.tremor_rms = 0.0;
  kicked.device.passivity.reaction = passivity::Reaction::kOff;
  const Played played = play(kicked);
  std::vector<double> speed;
  for (const Instant& now : played.instants) {
    if (now.time_s >= end_s) speed.push_back(now.twist.tail<3>().norm());
  }
  if (speed.empty()) return {.failure = played.failure};
  if (!played.failure.empty()) return {};
  return {.verdict = experiments::judge_decay(speed, config.calm, kicked.device.model.rate_Hz)};
}

}  // namespace hg::haptify

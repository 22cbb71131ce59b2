#include "hg/experiments/haptify/free_space.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "hg/experiments/changes.h"
#include "hg/experiments/player.h"
#include "hg/workspace/survey.h"

namespace hg::haptify {
namespace {

constexpr int kAzimuth = 3;  // channel of a script in the base frame

}  // namespace

person::Script exploration(const FreeSpaceConfig& config, const config::HandPose& start,
                           std::uint64_t seed) {
  Random random(seed);
  const auto between = [&](double low, double high) { return std::lerp(low, high, random.next()); };
  person::Script script;
  Eigen::Vector3d p = start.p;
  double azimuth = start.azimuth;
  double time = 0.5;
  while (time < config.duration_s) {
    Eigen::Vector3d next;
    for (int axis = 0; axis < 3; ++axis)
      next[axis] = between(config.lower[axis], config.upper[axis]);
    azimuth = std::clamp(azimuth + between(-config.turn, config.turn),
                         start.azimuth - config.turn_range, start.azimuth + config.turn_range);
    const double duration =
        std::max(1.0, (next - p).norm() / between(config.slowest, config.fastest));
    for (int axis = 0; axis < 3; ++axis) {
      script.segments.push_back(
          {.start_s = time, .duration_s = duration, .channel = axis, .value = next[axis]});
    }
    script.segments.push_back(
        {.start_s = time, .duration_s = duration, .channel = kAzimuth, .value = azimuth});
    p = next;
    time += duration;
  }
  script.duration_s = config.duration_s;
  return script;
}

FreeSpace measure_free_space(const config::Scenario& scenario, const FreeSpaceConfig& config,
                             std::uint64_t seed, const Disturbance& disturbance) {
  const experiments::FreeTwin twin = experiments::free_twin_of(scenario);
  const Pose start = scenario.twin.T_B_root;
  const auto& q = scenario.twin.model.q_start;
  const Eigen::Matrix3d R = Eigen::Quaterniond(q[6], q[3], q[4], q[5]).toRotationMatrix();
  const config::HandPose hand =
      config::hand_of({.p = start.p + start.R * q.head<3>(), .R = start.R * R});
  config::Scenario led = with_script(scenario, exploration(config, hand, seed));
  experiments::set_seed(led, seed);

  const Played played = play(led, disturbance);
  const double rate_Hz = led.device.model.rate_Hz;
  std::vector<HandleSample> motion;
  std::vector<Eigen::Vector3d> acceleration;
  FreeSpace result = {.failure = played.failure};
  double squares = 0.0, limited = 0.0, apart = 0.0;
  for (const Instant& now : played.instants) {
    motion.push_back({now.twist.head<3>(), now.acceleration.head<3>(), now.w_H.head<3>()});
    if (now.time_s < config.settling_s) continue;
    acceleration.push_back(now.acceleration.head<3>());
    squares += now.twist.head<3>().squaredNorm();
    result.path += now.twist.head<3>().norm() / rate_Hz;
    limited += now.is_limited ? 1.0 : 0.0;
    apart += (now.T_B_H.p - now.p_B_E).squaredNorm();
    result.joint_error = std::max(result.joint_error, now.joint_error);
    result.torque_share = std::max(result.torque_share, now.torque_share);
  }
  if (acceleration.empty()) return result;
  const auto count = static_cast<double>(acceleration.size());
  const Feel feel = haptify::feel(motion, twin, rate_Hz, config.settling_s);
  const Vibration shaking = vibration(acceleration, rate_Hz);
  result.force = feel.force;
  result.own_share = feel.own_share;
  result.extra = feel.extra;
  result.speed_rms = std::sqrt(squares / count);
  result.vibration_rms = shaking.rms;
  result.centroid_Hz = shaking.centroid_Hz;
  result.band_rms = shaking.band_rms;
  result.acceleration_5Hz = feel.acceleration_5Hz;
  result.spectrum = shaking.spectrum;
  const double density = led.device.simulation.sensors.accelerometer.noise;
  const Vibration seen = vibration(with_noise(acceleration, density, rate_Hz, seed), rate_Hz);
  result.seen_rms = seen.rms;
  result.seen_centroid_Hz = seen.centroid_Hz;
  result.limited_share = limited / count;
  result.distance_rms = std::sqrt(apart / count);
  return result;
}

}  // namespace hg::haptify

#include "hg/experiments/haptify/dynamics.h"

#include <algorithm>
#include <cmath>

#include "hg/core/linear_algebra.h"
#include "hg/experiments/haptify/play.h"
#include "hg/experiments/player.h"

namespace hg::haptify {
namespace {

// To and fro about the start: half a stroke away, whole strokes, and back.
person::Script strokes(const DynamicsConfig& config, int axis) {
  const double length = axis < 3 ? config.stroke : config.angle;
  person::Script script;
  double time = 0.7, side = 0.5;
  const auto move = [&](double duration, double by) {
    script.segments.push_back({.start_s = time,
                               .duration_s = duration,
                               .channel = axis,
                               .blend = person::Blend::kBy,
                               .value = by});
    time += duration;
  };
  move(0.8, 0.5 * length);
  for (const double duration : config.duration_s) {
    for (int i = 0; i < config.strokes; ++i) {
      move(duration, -2.0 * side * length);
      side = -side;
    }
  }
  script.duration_s = time;
  return script;
}

// The direction in B along (or about) which it moved most.
Eigen::Vector3d main_axis(const std::vector<Instant>& instants, int axis) {
  if (axis < 3) return Eigen::Vector3d::Unit(axis);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Instant& now : instants) {
    const Eigen::Vector3d omega = now.twist.tail<3>();
    spread += omega * omega.transpose();
  }
  return symmetric_eigen(spread).vectors.col(2);
}

}  // namespace

Dynamics measure_dynamics(const config::Scenario& scenario, const DynamicsConfig& config, int axis,
                          std::uint64_t seed) {
  config::Scenario stroked = with_script(scenario, strokes(config, axis));
  stroked.twin.model.q_start.head<3>() = config.position;
  experiments::set_seed(stroked, seed);
  const Played played = play(stroked);
  const Eigen::Vector3d direction = main_axis(played.instants, axis);
  const Eigen::Index part = axis < 3 ? 0 : 3;
  Dynamics result = {.failure = played.failure};
  std::vector<double> f, v, a;
  for (const Instant& now : played.instants) {
    if (now.time_s < 0.7) continue;  // the hand has just taken the handle
    f.push_back(direction.dot(now.w_H.segment<3>(part)));
    v.push_back(direction.dot(now.twist.segment<3>(part)));
    a.push_back(direction.dot(now.acceleration.segment<3>(part)));
    result.mean += std::abs(f.back());
    result.largest = std::max(result.largest, std::abs(f.back()));
  }
  if (f.size() < 10) return result;
  result.mean /= static_cast<double>(f.size());
  result.fit = fit_dynamics(f, v, a);
  return result;
}

}  // namespace hg::haptify

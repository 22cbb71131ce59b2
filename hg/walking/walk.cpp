#include "hg/walking/walk.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace hg::walking {
namespace {

void count(const WalkMoment& moment, const Redirection& redirection, WalkFigures& figures) {
  constexpr double kWalking = 0.2;  // m/s, slower people sway
  const double distance = moment.distance(), turn = moment.turn();
  const double speed = moment.sample().v.norm();
  figures.length += distance;
  figures.turn_rate =
      std::max(figures.turn_rate, std::abs(redirection.bend + redirection.twist) / kWalkPeriod);
  if (speed > kWalking && distance > 0.0) {
    const double bend = std::abs(redirection.bend) / std::max(distance, speed * kWalkPeriod);
    figures.bends.emplace_back(bend, distance);
    if (bend > 1.0 / kNoticedRadius) figures.bent += distance;
    const double gain = 1.0 / redirection.length;
    figures.way_gain_least = std::min(figures.way_gain_least, gain);
    figures.way_gain_most = std::max(figures.way_gain_most, gain);
  }
  if (redirection.twist != 0.0 && turn != 0.0) {
    const double gain = 1.0 + redirection.twist / turn;
    if (!(gain >= kLeastTurn && gain <= kMostTurn)) figures.twisted += std::abs(turn);
  }
}

}  // namespace

void WalkFigures::add(const WalkFigures& other) {
  clearance = length == 0.0 ? other.clearance : std::min(clearance, other.clearance);
  length += other.length;
  duration += other.duration;
  resets += other.resets;
  way_gain_least = std::min(way_gain_least, other.way_gain_least);
  way_gain_most = std::max(way_gain_most, other.way_gain_most);
  turn_rate = std::max(turn_rate, other.turn_rate);
  bent += other.bent;
  twisted += other.twisted;
  const auto own = static_cast<std::ptrdiff_t>(bends.size());
  bends.insert(bends.end(), other.bends.begin(), other.bends.end());
  std::inplace_merge(bends.begin(), bends.begin() + own, bends.end());
}

double WalkFigures::bend_quantile(double share) const {
  double way = 0.0;
  for (const auto& [bend, distance] : bends) way += distance;
  double passed = 0.0;
  for (const auto& [bend, distance] : bends) {
    passed += distance;
    if (passed >= share * way) return bend;
  }
  return 0.0;
}

WalkFigures walk(const WalkedPath& path, Redirector& redirector, const WalkRoom& room,
                 const WalkObserver& observe) {
  PlanarPose pose = {.p = room.walls.middle()};
  WalkFigures figures;
  figures.clearance = room.walls.clearance(pose.p);
  for (std::size_t i = 1; i < path.samples.size(); ++i) {
    const WalkMoment moment = {.path = path, .index = i, .room = pose};
    const Redirection redirection = redirector.step(moment);
    count(moment, redirection, figures);
    // the person's step, seen from the person, then turned into the room
    const double seen = pose.heading - moment.last().heading + 0.5 * redirection.bend;
    pose.p +=
        redirection.length * (Eigen::Rotation2Dd(seen) * (moment.sample().p - moment.last().p));
    pose.heading =
        std::remainder(pose.heading + moment.turn() + redirection.bend + redirection.twist,
                       2.0 * std::numbers::pi);
    figures.clearance = std::min(figures.clearance, room.walls.clearance(pose.p));
    if (room.needs_reset(pose)) {
      ++figures.resets;
      pose.heading = redirector.heading_after_reset({.path = path, .index = i, .room = pose});
      if (room.needs_reset(pose)) {  // in a corner
        const Eigen::Vector2d way = room.walls.middle() - pose.p;
        pose.heading = std::atan2(way.y(), way.x());
      }
    }
    if (observe) observe(moment, pose);
  }
  std::ranges::sort(figures.bends);
  figures.duration = static_cast<double>(path.samples.size() - 1) * kWalkPeriod;
  return figures;
}

}  // namespace hg::walking

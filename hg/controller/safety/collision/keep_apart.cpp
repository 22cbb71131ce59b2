#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "hg/controller/safety/collision/braking_path.h"
#include "hg/controller/safety/collision/guard.h"

namespace hg::collision {
namespace {

constexpr double kNear = 0.1;    // m, of bounds: pairs that are farther away do not matter
constexpr int kPlaces = 5;       // on the path where the distance is computed, both ends included
constexpr int kSteps = 4;        // of the search between them
constexpr double kAlike = 0.05;  // m: pairs that are so much farther away are not searched
constexpr double kRound = 3e-3;  // m: pairs whose distances differ by less share the change
constexpr double kGentle = 0.6;  // share of the ratings with which the law is to brake
constexpr double kOnset = 0.04;  // s: motors build up their torques meanwhile
constexpr double kLeastShare = 1e-3;
constexpr double kStep = 1e-6;  // s, and rad/s or m/s, of differences

}  // namespace

// How a distance changes with where the joints are at a time of the path.
struct Guard::Change {
  double time = 0.0;
  VectorPM there, per_position;

  /// Change on another path, m.
  double on(const BrakingPath& path) const noexcept {
    return per_position.dot(path.positions(time) - there);
  }
};

struct Guard::Foreseen {
  int pair = -1;
  double time = 0.0;
  double left = kInfinity;  // distance beyond the allowed one, m
};

// The smallest distances of these pairs at some places of the path.
void Guard::foresee(std::span<Foreseen> near, const BrakingPath& path,
                    const CollisionState& state) noexcept {
  double duration = 0.0;
  for (const Foreseen& place : near) {
    duration = std::max(duration, path.duration(config_.pairs.watched[place.pair]));
  }
  for (int k = 0; k < (duration > 0.0 ? kPlaces : 1); ++k) {
    const double time = duration * k / (kPlaces - 1);
    later_->update_poses(path.positions(time));
    for (Foreseen& place : near) {
      const double left = distance(place.pair, *later_) - state.allowed[place.pair];
      if (left < place.left) place = {place.pair, time, left};
    }
  }
}

// Searches between the neighbours of the best place so far.
void Guard::refine(Foreseen& best, const BrakingPath& path, double allowed) noexcept {
  const double duration = path.duration(config_.pairs.watched[best.pair]);
  double width = duration / (kPlaces - 1);
  for (int step = 0; step < kSteps && duration > 0.0; ++step) {
    width *= 0.5;
    const double middle = std::min(best.time, duration);
    for (const double side : {-width, width}) {
      const double time = middle + side;
      if (!(time > 0.0 && time < duration)) continue;
      const double left = distance(best.pair, path, time) - allowed;
      if (left < best.left) best = {best.pair, time, left};
    }
  }
}

// `share` of the change of the distance at the nearest place with each joint's position there: at
// an end of the path, or where it is smallest along it, it does not change with the time.
Guard::Change Guard::change_at(const Foreseen& nearest, const BrakingPath& path,
                               double share) noexcept {
  const Pair& pair = config_.pairs.watched[nearest.pair];
  const std::array<int, 2> frames = {config_.shapes[pair.a].frame, config_.shapes[pair.b].frame};
  Change change = {.time = nearest.time,
                   .there = path.positions(nearest.time),
                   .per_position = VectorPM::Zero(path.q.size())};
  later_->update_kinematics(change.there, path.dq);
  const std::array<Pose, 2> T_B = poses(nearest.pair, *later_);
  const Distance::Witnesses found = distances_[nearest.pair].witnesses(T_B[0], T_B[1]);
  Eigen::Vector3d normal = found.b - found.a;
  if (!(normal.norm() > 0.0)) return change;
  normal *= (found.distance < 0.0 ? -share : share) / normal.norm();
  for (const int side : {0, 1}) {
    if (frames[side] < 0) continue;
    const model::Jacobian& J = later_->jacobian(frames[side]);
    const Eigen::Vector3d& point = side == 0 ? found.a : found.b;
    const Eigen::Vector3d turn = (point - T_B[side].p).cross(normal);
    const double sign = side == 0 ? -1.0 : 1.0;
    change.per_position.noalias() += sign * J.topRows<3>().transpose() * normal;
    change.per_position.noalias() += sign * J.bottomRows<3>().transpose() * turn;
  }
  return change;
}

CollisionTask Guard::keep_apart(const VectorPM& q, const VectorPM& dq,
                                const CollisionState& state) noexcept {
  CollisionTask task;
  std::array<Foreseen, kMaxPairs> all;
  int count = 0;
  for (int i = 0; i < state.count; ++i) {
    if (state.left[i] < kNear) all[count++].pair = i;
  }
  if (count == 0) return task;
  const std::span near = std::span(all).first(count);
  Braking gentle = braking_;
  gentle.deceleration *= kGentle;
  gentle.reaction.array() += kOnset;
  const BrakingPath path(gentle, q, dq);
  foresee(near, path, state);
  const auto least_left = [&] { return std::ranges::min(near, {}, &Foreseen::left).left; };
  const double nearest = least_left();
  for (Foreseen& place : near) {
    if (place.left < nearest + kAlike) refine(place, path, state.allowed[place.pair]);
  }

  const double least = least_left();
  double sum = 0.0;
  for (const Foreseen& place : near) sum += std::exp((least - place.left) / kRound);
  task.distance = least - kRound * std::log(sum);
  std::array<Change, kMaxPairs> changes;
  int changing = 0;
  for (const Foreseen& place : near) {
    const double share = std::exp((least - place.left) / kRound) / sum;
    if (share > kLeastShare) changes[changing++] = change_at(place, path, share);
  }
  const auto change_on = [&](const BrakingPath& other) {
    double change = 0.0;
    for (int i = 0; i < changing; ++i) change += changes[i].on(other);
    return change / kStep;
  };
  // by differences: the ends of joints bend the path, so that it changes with positions, too
  const VectorPM later = q + kStep * dq;
  task.rate = change_on(BrakingPath(gentle, later, dq));
  task.per_acceleration = VectorPM::Zero(q.size());
  VectorPM faster = dq;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    faster[i] = dq[i] + kStep;
    task.per_acceleration[i] = change_on(BrakingPath(gentle, q, faster));
    faster[i] = dq[i];
  }
  return task;
}

}  // namespace hg::collision

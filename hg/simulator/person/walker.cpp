#include "hg/simulator/person/walker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "hg/core/error.h"

namespace hg::person {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;

// [HANDBOOK] 5.2
constexpr double kForward = 0.35, kLeft = -0.15;         // m, hand from body
constexpr double kAcceleration = 1.0;                    // m/s^2
constexpr double kHeadingLag_s = 0.4;                    // s
constexpr double kReach = 0.65;                          // m
constexpr double kVertical_Hz = 1.8, kLateral_Hz = 0.9;  // gait
constexpr double kFullGait = 0.6;                        // m/s, slowest speed of 5.2

constexpr double kTurnSpeed = 0.5 * pi;   // rad/s, [A]: of the body, half of what 5.4 gives a hand
constexpr double kBraking = 0.7;          // m/s^2, [A]: gentler than a person can
constexpr double kArrival_s = 0.3;        // s, [A]: time constant of the last centimetres
constexpr double kArrivalDistance = 1.0;  // m, [A]: from here on the body turns to its goal
// At a door, [A]: room that a body keeps from the leaf, and that a hand makes for it; how far a
// person looks ahead; how fast the hand opens, and pushes harder when the leaf does not follow
constexpr double kRoomKept = kHalfBreadth + 0.05, kRoomMade = kHalfBreadth + 0.11;  // m
constexpr double kAhead = 0.25;                                                     // m
constexpr int kStepsAhead = 10;
constexpr double kBesideFrame = 0.08;  // m, between shoulder and frame, opposite the hinge
constexpr double kOpening = 1.0;       // rad/s
constexpr double kPatience_s = 1.5, kEffort = 0.5;  // s, rad
constexpr double kLetGo_s = 0.2;
constexpr double kNear = 0.10;                    // m, [HANDBOOK] 5.3
constexpr double kNearAngle = 15.0 * pi / 180.0;  // rad, [HANDBOOK] 5.3

Vector2d forward(double heading) { return {std::cos(heading), std::sin(heading)}; }
Vector2d left(double heading) { return {-std::sin(heading), std::cos(heading)}; }

// position of the hand relative to the body
Vector2d hand_offset(double heading) { return kForward * forward(heading) + kLeft * left(heading); }

double turned(double from, double to) { return std::remainder(to - from, 2.0 * pi); }

// Radius of the body's path when its hand follows `walk.circle_radius`: the heading lags behind the
// tangent, which moves the hand outwards. Not positive: the circle is too small.
double body_radius(const Walk& walk) {
  const double lag = walk.speed / walk.circle_radius * kHeadingLag_s;
  const double along = kForward * std::cos(lag) + kLeft * std::sin(lag);
  const double outwards = kForward * std::sin(lag) - kLeft * std::cos(lag);
  const double squared = walk.circle_radius * walk.circle_radius - along * along;
  return squared > 0.0 ? std::sqrt(squared) - outwards : 0.0;
}

// speed from which the distance `d` suffices to stop
double arrival_speed(double d) {
  const double near = kBraking * kArrival_s * kArrival_s;
  return d < near ? d / kArrival_s : std::sqrt(kBraking * (2.0 * d - near));
}

}  // namespace

bool has_room(const Walk& walk) noexcept {
  return walk.speed < kTurnSpeed * walk.circle_radius && body_radius(walk) > 0.0;
}

bool has_room(const Doorway& doorway) noexcept {
  return doorway.clear_width >= 2.0 * kRoomMade + kBesideFrame;
}

void check_walk(const Walk& walk) {
  const auto require = [](bool ok, const std::string& rule) {
    if (!ok) throw SetupError("walk: " + rule);
  };
  require(walk.speed > 0.0, "speed must be positive");
  require(walk.vertical_bob >= 0.0 && walk.lateral_bob >= 0.0, "bob must not be negative");
  if (walk.kind == WalkKind::kCircle) {
    require(has_room(walk), "the circle is too small for a body that walks inside it");
  }
  if (walk.kind == WalkKind::kCheckpoints) {
    require(!walk.checkpoints.empty() && walk.checkpoints.size() <= kMaxCheckpoints,
            "1 to 16 checkpoints, got " + std::to_string(walk.checkpoints.size()));
  }
  if (walk.kind == WalkKind::kDoorway) {
    require(walk.doorway.leaf_width > 0.0, "leaf width must be positive");
    require(has_room(walk.doorway), "the doorway is too narrow for a person");
  }
}

Walker::Walker(Walk walk) : walk_(std::move(walk)) { check_walk(walk_); }

void Walker::start(const Eigen::Vector3d& p, double azimuth) noexcept {
  heading_ = walk_.kind == WalkKind::kDoorway
                 ? std::atan2(walk_.doorway.away.y(), walk_.doorway.away.x())
                 : azimuth - walk_.azimuth_from_heading;
  p_ = p.head<2>() - hand_offset(heading_);
  v_.setZero();
  angle_ = heading_ - 0.5 * pi;
  centre_ = p_ + body_radius(walk_) * left(heading_);
  gait_s_ = 0.0;
  reached_ = 0;
  leaf_goal_ = walk_.kind == WalkKind::kDoorway ? leaf_angle(walk_.doorway, p) : 0.0;
  effort_ = 0.0;
  let_go_s_ = -1.0;
}

void Walker::step(double dt, const Pose& T_B_H) noexcept {
  gait_s_ += dt;
  switch (walk_.kind) {
    case WalkKind::kNone:
      return;
    case WalkKind::kCircle:
      return walk_circle(dt);
    case WalkKind::kCheckpoints:
      return walk_to_checkpoint(dt, T_B_H);
    case WalkKind::kDoorway:
      return walk_through_doorway(dt, T_B_H);
  }
}

void Walker::walk_circle(double dt) noexcept {
  const double radius = body_radius(walk_);
  const double fastest = walk_.speed * radius / walk_.circle_radius;
  const double speed = std::min(v_.norm() + kAcceleration * dt, fastest);
  angle_ += speed / radius * dt;
  p_ = centre_ + radius * forward(angle_);
  v_ = speed * left(angle_);
  turn(dt, angle_ + 0.5 * pi);
}

void Walker::walk_to_checkpoint(double dt, const Pose& T_B_H) noexcept {
  const int count = static_cast<int>(walk_.checkpoints.size());
  const Checkpoint* goal = &walk_.checkpoints[std::min(reached_, count - 1)];

  // heading of the person implied by the orientation of the handle
  const double facing = std::atan2(T_B_H.R(1, 2), T_B_H.R(0, 2)) - walk_.azimuth_from_heading;
  if (reached_ < count && (T_B_H.p.head<2>() - goal->p).norm() < kNear &&
      std::abs(turned(facing, goal->heading)) < kNearAngle) {
    ++reached_;
    goal = &walk_.checkpoints[std::min(reached_, count - 1)];
  }

  const Vector2d way = goal->p - hand_offset(goal->heading) - p_;
  const double distance = way.norm();
  Vector2d wanted = Vector2d::Zero();
  if (distance > 0.0 && is_within_reach(T_B_H)) {
    wanted = way / distance * std::min(walk_.speed, arrival_speed(distance));
  }
  accelerate(dt, wanted);
  turn(dt, distance > kArrivalDistance ? std::atan2(way.y(), way.x()) : goal->heading);
}

// The body goes as far as the leaf leaves room, and waits before it; the hand opens the leaf as far
// as the body, and what is ahead of it, needs: the longer the leaf lags, the harder.
void Walker::walk_through_doorway(double dt, const Pose& T_B_H) noexcept {
  const Doorway& doorway = walk_.doorway;
  if (gait_s_ < doorway.start_s) return;
  const double leaf = leaf_angle(doorway, T_B_H.p);
  const Vector2d here = doorway.local(p_);
  const bool has_let_go = let_go_s_ >= 0.0;
  if (!has_let_go && is_clear_of_leaf(doorway, here, kRoomKept)) let_go_s_ = gait_s_;

  const double lane = doorway.clear_width - kHalfBreadth - kBesideFrame;
  const Vector2d ahead = Vector2d(lane - here.x(), kAhead).normalized();
  double free = 0.0, needed = 0.0;
  bool is_free = true;
  for (int i = 0; i <= kStepsAhead; ++i) {
    const double distance = kAhead * i / kStepsAhead;
    const Vector2d there = here + distance * ahead;
    is_free = is_free && angle_needed(doorway, there, kRoomKept) <= leaf;
    if (is_free) free = distance;
    needed = std::max(needed, angle_needed(doorway, there, kRoomMade));
  }
  double opened = leaf_goal_ - effort_;
  opened += std::clamp(needed - opened, -kOpening * dt, kOpening * dt);
  effort_ = std::clamp(effort_ + dt / kPatience_s * (opened - leaf), 0.0, kEffort);
  leaf_goal_ = opened + effort_;

  double speed = std::min(walk_.speed, arrival_speed(std::max(0.0, doorway.beyond - here.y())));
  if (!has_let_go && !is_free) speed = std::min(speed, arrival_speed(free));
  if (!has_let_go && !is_within_reach(T_B_H)) speed = 0.0;
  const Vector2d direction = ahead.x() * doorway.along + ahead.y() * doorway.away;
  accelerate(dt, speed * direction);
  turn(dt, std::atan2(direction.y(), direction.x()));
}

void Walker::accelerate(double dt, const Vector2d& wanted) noexcept {
  const Vector2d change = wanted - v_;
  v_ += change * std::min(1.0, kAcceleration * dt / std::max(change.norm(), 1e-12));
  p_ += dt * v_;
}

bool Walker::is_within_reach(const Pose& T_B_H) const noexcept {
  return (T_B_H.p - shoulder()).head<2>().norm() <= kReach;
}

double Walker::hold() const noexcept {
  return let_go_s_ < 0.0 ? 1.0 : std::max(0.0, 1.0 - (gait_s_ - let_go_s_) / kLetGo_s);
}

// the heading follows with a lag, limited by the turning speed of a person
void Walker::turn(double dt, double heading) noexcept {
  heading_ += dt * std::clamp(turned(heading_, heading) / kHeadingLag_s, -kTurnSpeed, kTurnSpeed);
}

Eigen::Vector3d Walker::bob() const noexcept {
  const double gait = std::min(1.0, v_.norm() / kFullGait);
  const double sway = walk_.lateral_bob * gait * std::sin(2.0 * pi * kLateral_Hz * gait_s_);
  Eigen::Vector3d bob;
  bob << sway * left(heading_),
      walk_.vertical_bob * gait * std::sin(2.0 * pi * kVertical_Hz * gait_s_);
  return bob;
}

Eigen::Vector3d Walker::hand() const noexcept {
  Eigen::Vector3d hand = bob();
  hand.head<2>() += p_ + hand_offset(heading_);
  return hand;
}

Eigen::Vector3d Walker::shoulder() const noexcept {
  Eigen::Vector3d shoulder = Eigen::Vector3d::Zero();
  shoulder.head<2>() = p_ + kLeft * left(heading_);
  return shoulder;
}

}  // namespace hg::person

/// A person on foot: the motion of the body and the resulting position of the hand.
///
/// Source: [HANDBOOK] 5.2 (walking), 5.3 (checkpoints, door). The body accelerates with at most 1
/// m/s^2 and turns to its path with a lag of 0.4 s; the desired position of the hand is R(heading)
/// (0.35, -0.15) from the body, plus the bob of the gait; at a door it is on the arc of its handle.
/// SI units, everything in B. No allocation, noexcept after set-up.
#pragma once

#include <array>
#include <vector>

#include "hg/simulator/person/doorway.h"
#include "hg/simulator/person/hand.h"

namespace hg::person {

enum class WalkKind {
  kNone,         ///< the person stands
  kCircle,       ///< the hand goes round a circle, counterclockwise
  kCheckpoints,  ///< the hand goes from checkpoint to checkpoint
  kDoorway,      ///< the body goes through a doorway, the hand opens its leaf
};

inline constexpr int kMaxCheckpoints = 16;

/// Target of a walk; reached when the handle is nearer than 0.10 m and 15 degrees.
struct Checkpoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< position of the handle
  double heading = 0.0;                         ///< heading of the person, rad
};

struct Walk {
  WalkKind kind = WalkKind::kNone;
  double speed = 0.6;           ///< speed of the hand on a circle, else of the body, m/s
  double circle_radius = 0.7;   ///< radius of the hand's circle, m
  double vertical_bob = 0.015;  ///< bob of the hand at 0.6 m/s and more, less when slower, m
  double lateral_bob = 0.02;    ///< m
  /// Azimuth of the handle relative to the person's heading, rad
  double azimuth_from_heading = 0.0;
  std::vector<Checkpoint> checkpoints;
  Doorway doorway;
};

/// Whether the body has room inside the circle of its hand.
bool has_room(const Walk& walk) noexcept;
/// Whether a person fits through the doorway beside its open leaf.
bool has_room(const Doorway& doorway) noexcept;
/// Throws SetupError naming the field that is out of range.
void check_walk(const Walk& walk);

/// Measures of how well a path was followed.
struct Score {
  int reached = 0;  ///< checkpoints reached
  /// Time at each checkpoint since the previous one, s
  std::array<double, kMaxCheckpoints> time_s{};
  double path_length = 0.0;      ///< path of the handle, in the plane, until the last checkpoint, m
  double straight_length = 0.0;  ///< length of the same path along straight lines, m
  double mean_force = 0.0;       ///< mean norm of the person's force along the way, N
};

class Walker {
 public:
  explicit Walker(Walk walk);

  /// Places the body where the hand reaches a handle at `p` with azimuth `azimuth`.
  void start(const Eigen::Vector3d& p, double azimuth) noexcept;
  /// Walks for `dt`, given the pose of the handle.
  void step(double dt, const Pose& T_B_H) noexcept;

  /// Desired position of the hand; height 0 plus the bob.
  Eigen::Vector3d hand() const noexcept;
  /// What the gait adds to the position of the hand.
  Eigen::Vector3d bob() const noexcept;
  Eigen::Vector2d body() const noexcept { return p_; }
  /// Position of the shoulder, at height 0.
  Eigen::Vector3d shoulder() const noexcept;
  double heading() const noexcept { return heading_; }
  double speed() const noexcept { return v_.norm(); }
  /// Angle at which the hand wants the leaf of the doorway, rad.
  double leaf_goal() const noexcept { return leaf_goal_; }
  /// How much the hand still holds the handle, 0 to 1: at a door it lets go once the leaf, falling
  /// shut, can no longer hit the body.
  double hold() const noexcept;
  /// Number of checkpoints reached.
  int reached() const noexcept { return reached_; }
  const Walk& walk() const noexcept { return walk_; }

 private:
  void walk_circle(double dt) noexcept;
  void walk_to_checkpoint(double dt, const Pose& T_B_H) noexcept;
  void walk_through_doorway(double dt, const Pose& T_B_H) noexcept;
  void accelerate(double dt, const Eigen::Vector2d& wanted) noexcept;
  void turn(double dt, double heading) noexcept;
  bool is_within_reach(const Pose& T_B_H) const noexcept;

  Walk walk_;
  /// Position and velocity of the body
  Eigen::Vector2d p_ = Eigen::Vector2d::Zero(), v_ = Eigen::Vector2d::Zero();
  double heading_ = 0.0;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();  ///< centre of the circle
  double angle_ = 0.0;                                ///< angle of the body on the circle
  double gait_s_ = 0.0;                               ///< time spent walking
  int reached_ = 0;
  double leaf_goal_ = 0.0;
  double effort_ = 0.0;     ///< what is added to the angle that the body needs, rad
  double let_go_s_ = -1.0;  ///< time on `gait_s_` at which the hand lets go; -1: it has not
};

}  // namespace hg::person

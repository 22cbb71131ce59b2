/// A person on foot: where the body goes, and where that brings the hand.
///
/// Source: [HANDBOOK] 5.2 (walking), 5.3 (checkpoints). The body accelerates with at most 1 m/s^2
/// and turns to its path with a lag of 0.4 s; the hand wants to be R(heading) (0.35, -0.15) before
/// it, plus the bob of the gait. SI units, everything in B. No allocation, noexcept after set-up.
#pragma once

#include <array>
#include <vector>

#include "hg/user/hand.h"

namespace hg::user {

enum class WalkKind {
  kNone,         ///< the person stands
  kCircle,       ///< the hand goes round a circle, counterclockwise
  kCheckpoints,  ///< the hand goes from checkpoint to checkpoint
};

inline constexpr int kMaxCheckpoints = 16;

/// Reached when the handle is nearer than 0.10 m and 15 degrees.
struct Checkpoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< of the handle
  double heading = 0.0;                         ///< of the person, rad
};

struct Walk {
  WalkKind kind = WalkKind::kNone;
  double speed = 0.6;                 ///< of the hand on a circle, else of the body, m/s
  double circle_radius = 0.7;         ///< of the hand, m
  double vertical_bob = 0.015;        ///< of the hand at 0.6 m/s and more, less when slower, m
  double lateral_bob = 0.02;          ///< m
  double azimuth_from_heading = 0.0;  ///< of the handle, rad: how the person stands to it
  std::vector<Checkpoint> checkpoints;
};

/// The body has room inside the circle of its hand.
bool has_room(const Walk& walk) noexcept;
/// Throws SetupError naming the field that is out of range.
void check(const Walk& walk);

/// How well a path was followed.
struct Score {
  int reached = 0;                               ///< checkpoints
  std::array<double, kMaxCheckpoints> time_s{};  ///< at each, since the last one
  double path_length = 0.0;      ///< of the handle, in the plane, until the last checkpoint, m
  double straight_length = 0.0;  ///< the same along straight lines, m
  double mean_force = 0.0;       ///< mean norm of the person's force on the way, N

  /// 1 = straight; 0 before the first checkpoint.
  double path_ratio() const noexcept {
    return straight_length > 0.0 ? path_length / straight_length : 0.0;
  }
};

class Walker {
 public:
  explicit Walker(Walk walk);

  /// Stands where the hand reaches a handle at `p` with azimuth `azimuth`.
  void start(const Eigen::Vector3d& p, double azimuth) noexcept;
  /// Walks on for `dt`; sees where the handle is.
  void step(double dt, const Pose& T_B_H) noexcept;

  /// Where the hand wants to be; height 0 plus the bob.
  Eigen::Vector3d hand() const noexcept;
  Eigen::Vector2d body() const noexcept { return p_; }
  /// At height 0.
  Eigen::Vector3d shoulder() const noexcept;
  double heading() const noexcept { return heading_; }
  double speed() const noexcept { return v_.norm(); }
  /// Checkpoints that have been reached.
  int reached() const noexcept { return reached_; }
  const Walk& walk() const noexcept { return walk_; }

 private:
  void walk_circle(double dt) noexcept;
  void walk_to_checkpoint(double dt, const Pose& T_B_H) noexcept;
  void turn(double dt, double heading) noexcept;

  Walk walk_;
  Eigen::Vector2d p_ = Eigen::Vector2d::Zero(), v_ = Eigen::Vector2d::Zero();  ///< body
  double heading_ = 0.0;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();  ///< of the circle
  double angle_ = 0.0;                                ///< of the body on it
  double gait_s_ = 0.0;                               ///< time spent walking
  int reached_ = 0;
};

}  // namespace hg::user

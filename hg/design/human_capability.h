/// What a human arm can do: poses of the hand that it reaches, and how fast and how strong it is in
/// each.
///
/// Source: [HG] III-B, [HANDBOOK] 8.2, 8.3. Joint vectors are drawn uniformly in their ranges;
/// those that enter the body are left out. Each pose falls into a cell: a cube of space times a
/// cell of orientations, all of equal volume. A cell keeps the posture of the largest
/// manipulability.
///
/// An ellipsoid is its shape matrix S: all x with x^T S^-1 x <= 1, so that its radius along a unit
/// vector n is 1 / sqrt(n^T S^-1 n). Frame F of human_arm.h, SI units. The same options and seed
/// give the same poses.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/design/human_arm.h"

namespace hg::design {

/// What a pose of the hand counts.
enum class PoseWeight {
  kOne,     ///< Each cell the same
  kSamples  ///< The number of drawn joint vectors in its cell: ends of ranges count little
};

struct CapabilityOptions {
  std::uint64_t seed = 1;
  int samples = 1'000'000;  ///< Joint vectors to draw
  /// Cells to keep, drawn at random from all; 0 = all. With n of them a coverage is good to about
  /// 1 / (2 sqrt(n))
  int poses = 1000;
  double voxel = 0.1;         ///< Edge of a cube, m
  int orientation_bands = 6;  ///< Bands of the hand's direction; 2 n of azimuth, 2 n of roll
  PoseWeight weight = PoseWeight::kOne;
  /// Share of the largest speeds and accelerations that the person uses, above 0 to 1; unhurried
  /// everyday motions take about half, [HANDBOOK] 8.1 [A]
  double effort = 1.0;
};

/// One pose of the hand, and the ellipsoids of the hand in it.
struct HandPose {
  Pose T_F_hand;
  ArmVector q;                                      ///< The posture that was kept, rad
  double weight = 1.0;                              ///< What the pose counts
  Eigen::Matrix3d velocity, turn_velocity;          ///< (m/s)^2, (rad/s)^2
  Eigen::Matrix3d acceleration, turn_acceleration;  ///< At rest; (m/s^2)^2, (rad/s^2)^2
  Eigen::Matrix3d force, torque;                    ///< At rest, without gravity; N^2, (Nm)^2
};

struct HumanCapability {
  HumanArm arm;
  CapabilityOptions options;
  double share_clear = 0.0;  ///< Share of the joint vectors that do not enter the body
  int voxels = 0;            ///< Cubes that the hand reaches
  double volume = 0.0;       ///< Of these cubes, m^3
  int cells = 0;             ///< Cells reached: cubes times orientations
  std::vector<HandPose> poses;
};

/// Throws SetupError where an option is out of range.
HumanCapability human_capability(const HumanArm& arm, const CapabilityOptions& options = {});

/// The pose and ellipsoids of one posture; weight 1. `effort`: see CapabilityOptions.
HandPose hand_pose(const HumanArm& arm, const ArmVector& q, double effort = 1.0);

}  // namespace hg::design

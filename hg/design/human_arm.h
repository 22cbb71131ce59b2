/// The arm of a standing person: seven joints from anthropometry, with ranges, speeds,
/// accelerations and torques.
///
/// Sources, [HANDBOOK] 8.1 and docs/concepts/human_arm.md: stature by [GB14], lengths as shares of
/// it by [DC66], ranges by [BA79], speeds and accelerations of the handbook, torques of several. A
/// right arm; a left one is its mirror image.
///
/// Frame F stands on the floor under the middle of the person: x forward, y left, z up. The frame
/// of the hand has its origin in the middle of the grip: x along the hand away from the wrist, z
/// towards the thumb, y out of the palm. At q = 0 the arm hangs and the thumb points forward. SI
/// units.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"

namespace hg::design {

inline constexpr int kArmJoints = 7;

using ArmVector = Eigen::Matrix<double, kArmJoints, 1>;
using ArmJacobian = Eigen::Matrix<double, 6, kArmJoints>;

enum class Sex { kFemale, kMale };

std::string_view to_string(Sex sex) noexcept;

/// One joint of the arm.
struct ArmJoint {
  std::string_view name;
  Interval range;       ///< Positions, rad
  double dq_max = 0.0;  ///< Largest speed, rad/s
  double ddq_max = 0;   ///< Largest acceleration, rad/s^2
  double torque = 0.0;  ///< Largest torque at rest, the weaker direction, Nm
};

/// A part of the body that the arm may not enter: all points within `radius` of a segment.
struct Capsule {
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  ///< m, in F
  double radius = 0.0;                                                           ///< m
};

struct HumanArm {
  Sex sex = Sex::kMale;
  double stature = 0.0;                                  ///< m
  Eigen::Vector3d p_shoulder = Eigen::Vector3d::Zero();  ///< Middle of the shoulder joint, m, in F
  double upper_arm = 0.0, forearm = 0.0, hand = 0.0;     ///< Shoulder, elbow, wrist, grip; m
  std::array<ArmJoint, kArmJoints> joints;               ///< From shoulder to hand
  std::vector<Capsule> body;                             ///< Head, trunk and legs
};

/// Stature of a percentile of the population, m. Throws SetupError unless 0 < percentile < 100.
double stature_of(Sex sex, double percentile);

/// The arm of a person of this stature percentile; throws as stature_of().
HumanArm human_arm(Sex sex, double stature_percentile);

/// The arm of a person of this stature, m; throws SetupError unless it is 1.2 to 2.3 m.
HumanArm human_arm_of_stature(Sex sex, double stature);

/// Points of the arm and motion of the hand in one posture, in F.
struct ArmPosture {
  Eigen::Vector3d p_elbow, p_wrist;  ///< m
  Pose T_F_hand;
  ArmJacobian J;  ///< Jacobian of the hand, linear rows first
};

ArmPosture arm_posture(const HumanArm& arm, const ArmVector& q) noexcept;

/// Whether forearm, hand and the lower half of the upper arm stay outside the body.
bool is_clear_of_body(const HumanArm& arm, const ArmPosture& posture) noexcept;

}  // namespace hg::design

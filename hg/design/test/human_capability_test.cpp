#include "hg/design/human_capability.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "hg/core/error.h"
#include "hg/design/device_metrics.h"

namespace hg::design {
namespace {

CapabilityOptions small() { return {.samples = 20'000, .poses = 100}; }

TEST(HumanCapability, IsTheSameForTheSameSeed) {
  const HumanArm arm = human_arm(Sex::kMale, 50.0);
  const HumanCapability first = human_capability(arm, small()),
                        again = human_capability(arm, small());
  CapabilityOptions options = small();
  options.seed = 2;
  const HumanCapability other = human_capability(arm, options);
  ASSERT_EQ(first.poses.size(), 100U);
  bool differs = false;
  for (std::size_t i = 0; i < first.poses.size(); ++i) {
    EXPECT_EQ(first.poses[i].q, again.poses[i].q);
    differs = differs || first.poses[i].q != other.poses[i].q;
  }
  EXPECT_TRUE(differs);
}

TEST(HumanCapability, PosesAreWithinRangesAndOutsideTheBody) {
  const HumanArm arm = human_arm(Sex::kFemale, 5.0);
  for (const HandPose& pose : human_capability(arm, small()).poses) {
    for (int i = 0; i < kArmJoints; ++i) EXPECT_TRUE(arm.joints[i].range.contains(pose.q[i]));
    EXPECT_TRUE(is_clear_of_body(arm, arm_posture(arm, pose.q)));
  }
}

TEST(HumanCapability, ReachesNoMoreThanABallOfTheArmsLength) {
  const HumanArm arm = human_arm(Sex::kMale, 50.0);
  const double length = arm.upper_arm + arm.forearm + arm.hand;
  CapabilityOptions options = {.samples = 300'000, .poses = 2000, .voxel = 0.05};
  const HumanCapability human = human_capability(arm, options);
  for (const HandPose& pose : human.poses) {
    EXPECT_LE((pose.T_F_hand.p - arm.p_shoulder).norm(), length + 1e-12);
  }
  // cubes that the surface cuts count as a whole: half a cube more on each side
  EXPECT_LT(human.volume, 4.0 / 3.0 * M_PI * std::pow(length + 0.025, 3));
  EXPECT_GT(human.volume, 0.4 * 4.0 / 3.0 * M_PI * std::pow(length, 3));
}

// Against the exact sets: the image of the box of joint speeds is a zonotope, whose extent along n
// is the sum of v_i |J_i . n|, found here over all its corners.
TEST(HumanCapability, EllipsoidOfSpeedLiesInsideTheExactSet) {
  const HumanArm arm = human_arm(Sex::kMale, 50.0);
  const std::vector<Eigen::Vector3d> directions = half_sphere(100);
  for (const HandPose& pose : human_capability(arm, {.samples = 2000, .poses = 20}).poses) {
    const ArmJacobian J = arm_posture(arm, pose.q).J;
    for (const Eigen::Vector3d& n : directions) {
      double extent = 0.0;
      for (int corner = 0; corner < 1 << kArmJoints; ++corner) {
        ArmVector dq;
        for (int i = 0; i < kArmJoints; ++i) {
          dq[i] = (corner >> i & 1 ? 1 : -1) * arm.joints[i].dq_max;
        }
        extent = std::max(extent, n.dot(J.topRows<3>() * dq));
      }
      const double of_ellipsoid = std::sqrt(n.dot(pose.velocity * n));
      EXPECT_LE(of_ellipsoid, extent + 1e-12);
      EXPECT_GE(std::sqrt(7.0) * of_ellipsoid, extent - 1e-12);
    }
  }
}

TEST(HumanCapability, ForcesOfTheEllipsoidAreHeldByTheTorques) {
  const HumanArm arm = human_arm(Sex::kMale, 50.0);
  for (const HandPose& pose : human_capability(arm, {.samples = 2000, .poses = 20}).poses) {
    const ArmJacobian J = arm_posture(arm, pose.q).J;
    for (const Eigen::Vector3d& n : half_sphere(100)) {
      const double force = 1.0 / std::sqrt(n.dot(pose.force.inverse() * n));
      const ArmVector torques = J.topRows<3>().transpose() * (force * n);
      double used = 0.0;  // on the surface the torques, as shares of the largest, have length 1
      for (int i = 0; i < kArmJoints; ++i) used += std::pow(torques[i] / arm.joints[i].torque, 2);
      EXPECT_NEAR(used, 1.0, 1e-9);
    }
  }
}

// Fast, but no boxer: single punches of competitors, with trunk and legs, reach 9.3 m/s [PL11].
TEST(HumanCapability, FastestHandIsSlowerThanAPunch) {
  double fastest = 0.0;
  for (const HandPose& pose : human_capability(human_arm(Sex::kMale, 50.0), small()).poses) {
    fastest = std::max(fastest, std::sqrt(pose.velocity.eigenvalues().real().maxCoeff()));
  }
  EXPECT_LT(fastest, 9.3);
  EXPECT_GT(fastest, 3.0);
}

TEST(HumanCapability, HalfTheEffortIsHalfTheSpeed) {
  const HumanArm arm = human_arm(Sex::kMale, 50.0);
  const ArmVector q = ArmVector::Constant(0.4);
  const HandPose full = hand_pose(arm, q), half = hand_pose(arm, q, 0.5);
  EXPECT_LT((half.velocity - 0.25 * full.velocity).norm(), 1e-12);
  EXPECT_LT((half.turn_acceleration - 0.25 * full.turn_acceleration).norm(), 1e-9);
  EXPECT_EQ(half.force, full.force);
}

TEST(HumanCapability, OptionsOutOfRangeAreRefused) {
  const HumanArm arm = human_arm(Sex::kMale, 50.0);
  for (const CapabilityOptions& options :
       {CapabilityOptions{.samples = 0}, CapabilityOptions{.samples = 10, .voxel = 0.0},
        CapabilityOptions{.samples = 10, .orientation_bands = 0},
        CapabilityOptions{.samples = 10, .effort = 1.5}}) {
    EXPECT_THROW(human_capability(arm, options), SetupError);
  }
}

}  // namespace
}  // namespace hg::design

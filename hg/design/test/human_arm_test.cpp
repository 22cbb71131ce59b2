#include "hg/design/human_arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hg/core/error.h"
#include "hg/core/random.h"
#include "hg/core/rotation.h"

namespace hg::design {
namespace {

using std::numbers::pi;

constexpr double kRounding = 1e-12;

double grip_length(const HumanArm& arm) { return arm.upper_arm + arm.forearm + arm.hand; }

ArmVector posture(double flexion, double abduction, double rotation, double elbow) {
  ArmVector q = ArmVector::Zero();
  q.head<4>() << flexion, abduction, rotation, elbow;
  return q;
}

ArmVector random_posture(const HumanArm& arm, Random& random) {
  ArmVector q;
  for (int i = 0; i < kArmJoints; ++i) {
    q[i] = random.between(arm.joints[i].range.lb, arm.joints[i].range.ub);
  }
  return q;
}

TEST(HumanArm, StatureOfAPercentileIsThatOfTheSurvey) {
  // normal distributions: 1.645 standard deviations to the 95th percentile
  EXPECT_NEAR(stature_of(Sex::kMale, 50.0), 1.756, 1e-6);
  EXPECT_NEAR(stature_of(Sex::kMale, 95.0), 1.756 + 1.645 * 0.0686, 1e-4);
  EXPECT_NEAR(stature_of(Sex::kFemale, 5.0), 1.628 - 1.645 * 0.0642, 1e-4);
  for (double percentile : {0.0, 100.0, -1.0, std::nan("")}) {
    EXPECT_THROW(stature_of(Sex::kMale, percentile), SetupError) << percentile;
  }
  EXPECT_THROW(human_arm_of_stature(Sex::kMale, 0.9), SetupError);
}

// Shoulder-grip length of British adults, [PH06]: 5th, 50th and 95th percentile of men, 5th and
// 50th of women, with the stature of the same percentile.
TEST(HumanArm, ReachesAsFarAsPublishedTablesSay) {
  struct Row {
    Sex sex;
    double stature, grip_length;
  };
  for (const Row& row :
       {Row{Sex::kMale, 1.625, 0.610}, Row{Sex::kMale, 1.740, 0.665}, Row{Sex::kMale, 1.855, 0.715},
        Row{Sex::kFemale, 1.505, 0.555}, Row{Sex::kFemale, 1.610, 0.600}}) {
    const HumanArm arm = human_arm_of_stature(row.sex, row.stature);
    EXPECT_NEAR(grip_length(arm), row.grip_length, 0.025 * row.grip_length) << row.stature;
  }
}

// Height of the middle of the shoulder, [HU09]: 50th percentile.
TEST(HumanArm, ShoulderIsAsHighAsPublishedTablesSay) {
  EXPECT_NEAR(human_arm_of_stature(Sex::kMale, 1.759).p_shoulder.z(), 1.444, 0.015);
  EXPECT_NEAR(human_arm_of_stature(Sex::kFemale, 1.618).p_shoulder.z(), 1.314, 0.015);
}

TEST(HumanArm, HangsWithTheThumbForwardAndBendsForward) {
  const HumanArm arm = human_arm(Sex::kMale, 50.0);
  const ArmPosture hanging = arm_posture(arm, ArmVector::Zero());
  const Eigen::Vector3d grip = arm.p_shoulder - grip_length(arm) * Eigen::Vector3d::UnitZ();
  EXPECT_LT((hanging.T_F_hand.p - grip).norm(), kRounding);
  EXPECT_LT((hanging.T_F_hand.R.col(0) + Eigen::Vector3d::UnitZ()).norm(), kRounding);
  EXPECT_LT((hanging.T_F_hand.R.col(2) - Eigen::Vector3d::UnitX()).norm(), kRounding);
  EXPECT_NEAR(hanging.T_F_hand.R.determinant(), 1.0, kRounding);

  // elbow at a right angle: the hand forward, the thumb up, the palm to the left
  const Pose bent = arm_posture(arm, posture(0, 0, 0, pi / 2)).T_F_hand;
  EXPECT_LT((bent.R - Eigen::Matrix3d::Identity()).norm(), kRounding);
  EXPECT_NEAR(bent.p.x(), arm.forearm + arm.hand, kRounding);

  // then: internal rotation brings the hand to the middle, abduction the elbow outwards (right)
  EXPECT_GT(arm_posture(arm, posture(0, 0, 0.5, pi / 2)).T_F_hand.p.y(), bent.p.y());
  EXPECT_LT(arm_posture(arm, posture(0, 0.5, 0, 0)).p_elbow.y(), arm.p_shoulder.y());
  EXPECT_GT(arm_posture(arm, posture(0.5, 0, 0, 0)).p_elbow.x(), 0.0);
  ArmVector q = posture(0, 0, 0, pi / 2);
  q[4] = pi / 2;  // pronated: the palm down, the thumb to the left
  EXPECT_LT((arm_posture(arm, q).T_F_hand.R.col(2) - Eigen::Vector3d::UnitY()).norm(), kRounding);
  q[4] = 0.0;
  q[5] = 0.3;  // flexion: to the palm
  EXPECT_GT(arm_posture(arm, q).T_F_hand.p.y(), bent.p.y());
  q[5] = 0.0;
  q[6] = 0.3;  // radial deviation: to the thumb
  EXPECT_GT(arm_posture(arm, q).T_F_hand.p.z(), bent.p.z());
}

TEST(HumanArm, JacobianIsTheDerivativeOfThePose) {
  constexpr double kStep = 1e-6;
  const HumanArm arm = human_arm(Sex::kFemale, 30.0);
  Random random(3);
  for (int sample = 0; sample < 50; ++sample) {
    const ArmVector q = random_posture(arm, random);
    const ArmJacobian J = arm_posture(arm, q).J;
    for (int i = 0; i < kArmJoints; ++i) {
      ArmVector ahead = q, behind = q;
      ahead[i] += kStep;
      behind[i] -= kStep;
      const Pose a = arm_posture(arm, ahead).T_F_hand, b = arm_posture(arm, behind).T_F_hand;
      Vector6 expected;
      expected << a.p - b.p, rotation_between(b.R, a.R);
      EXPECT_LT((J.col(i) - expected / (2 * kStep)).norm(), 1e-8) << i;
    }
  }
}

TEST(HumanArm, DoesNotEnterTheBody) {
  const HumanArm arm = human_arm(Sex::kMale, 50.0);
  const auto is_clear = [&](const ArmVector& q) {
    return is_clear_of_body(arm, arm_posture(arm, q));
  };
  EXPECT_TRUE(is_clear(posture(0, 0, 0, 0)));           // hanging beside the body
  EXPECT_TRUE(is_clear(posture(0.3, 0.2, 0, pi / 2)));  // at work
  EXPECT_TRUE(is_clear(posture(pi / 2, 0, 0, 0)));      // stretched forward
  EXPECT_FALSE(is_clear(posture(0, 0, pi / 3, 2.0)));   // forearm through the chest
  EXPECT_FALSE(is_clear(posture(0, -0.4, 0, 0)));       // arm through the hip
}

}  // namespace
}  // namespace hg::design

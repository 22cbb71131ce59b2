#include "hg/identify/payload.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "hg/core/interval.h"
#include "hg/signals/payload.h"

namespace hg::identify {
namespace {

const Payload kHandle = {.mass = 1.18, .com = {0.004, -0.011, 0.032}};
const Vector6 kOffset = (Vector6() << 12, -7, 20, 0.4, -0.3, 0.2).finished();
using Axis = Eigen::Vector3d;

// The mean over half a second of a sensor whose orientation in B is R, with what remains of its
// noise, [HANDBOOK] 1.6: 0.08 N, 2.6 mNm at 1 kHz.
StaticPose pose_at(const Eigen::Matrix3d& R, std::mt19937* random = nullptr) {
  StaticPose pose;
  pose.a_S = R.transpose() * Eigen::Vector3d(0.0, 0.0, 9.81);
  pose.w_S = kOffset + payload_wrench(kHandle, pose.a_S, {0, 0, 0}, {0, 0, 0});
  if (random == nullptr) return pose;
  std::normal_distribution<double> normal;
  for (int i = 0; i < 6; ++i) {
    pose.w_S[i] += normal(*random) * (i < 3 ? 0.08 : 2.6e-3) / std::sqrt(500.0);
  }
  for (int i = 0; i < 3; ++i) pose.a_S[i] += normal(*random) * 0.03 / std::sqrt(500.0);
  return pose;
}

Eigen::Matrix3d turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

std::vector<StaticPose> good_poses(std::mt19937* random = nullptr) {
  std::vector<StaticPose> poses;
  for (const double pitch : {-0.9, 0.0, 0.9}) {
    for (const double roll : {-1.2, 0.0, 1.2}) {
      poses.push_back(pose_at(turn(pitch, Axis::UnitY()) * turn(roll, Axis::UnitX()), random));
    }
  }
  return poses;
}

TEST(IdentifyPayload, IsExactWithoutNoise) {
  const PayloadEstimate found = identify_payload(good_poses());
  EXPECT_NEAR(found.mass, kHandle.mass, 1e-12);
  EXPECT_LT((found.com - kHandle.com).norm(), 1e-12);
  EXPECT_LT((found.offset - kOffset).norm(), 1e-11);
  EXPECT_LT(found.force_residual, 1e-12);
  EXPECT_LT(found.torque_residual, 1e-12);
  EXPECT_EQ(found.missing, "");
}

class IdentifyPayloadSeeds : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, IdentifyPayloadSeeds, testing::Range(0u, 50u));

TEST_P(IdentifyPayloadSeeds, FindsMassWithin1PercentAndCentreWithin2Millimetres) {
  std::mt19937 random(GetParam());
  const std::vector<StaticPose> poses = good_poses(&random);
  const PayloadEstimate found = identify_payload(poses);
  EXPECT_EQ(found.missing, "");
  EXPECT_NEAR(found.mass, kHandle.mass, 0.01 * kHandle.mass);
  EXPECT_LT((found.com - kHandle.com).norm(), 2e-3);
  // the stated deviations are those of the errors
  EXPECT_LT(std::abs(found.mass - kHandle.mass), 5.0 * found.mass_deviation);
  EXPECT_LT((found.com - kHandle.com).norm(), 7.0 * found.com_deviation);
  EXPECT_GT(found.mass_deviation, 1e-5);
  EXPECT_GT(found.com_deviation, 1e-6);
}

TEST(IdentifyPayload, ReportsThatPosesAreAlike) {
  std::vector<StaticPose> poses;
  for (int k = 0; k < 8; ++k) poses.push_back(pose_at(turn(k, Axis::UnitZ())));
  const PayloadEstimate found = identify_payload(poses);
  EXPECT_NE(found.missing.find("hold the sensor alike"), std::string::npos) << found.missing;
  EXPECT_EQ(found.mass_deviation, kInfinity);
  EXPECT_EQ(found.com_deviation, kInfinity);
}

TEST(IdentifyPayload, ReportsAboutWhichAxisToTurn) {
  // upright and upside down: what is on the vertical axis turns nothing
  const std::vector<StaticPose> poses = {
      pose_at(turn(0, Axis::UnitX())), pose_at(turn(std::numbers::pi, Axis::UnitX())),
      pose_at(turn(1, Axis::UnitZ())), pose_at(turn(std::numbers::pi, Axis(1, 1, 0))),
      pose_at(turn(2, Axis::UnitZ())), pose_at(turn(std::numbers::pi, Axis(1, -1, 0)))};
  const PayloadEstimate found = identify_payload(poses);
  EXPECT_NEAR(found.mass, kHandle.mass, 1e-9) << "the mass shows";
  EXPECT_NE(found.missing.find("0.00, 1.00) of S does not show"), std::string::npos)
      << found.missing;
  EXPECT_GT(found.condition, 100.0);
}

TEST(IdentifyPayload, NeedsSixPoses) {
  const std::vector<StaticPose> all = good_poses();
  const auto with = [&](std::size_t count) {
    std::vector<StaticPose> some;
    for (std::size_t i = 0; i < count; ++i) some.push_back(all[(2 * i) % 9]);
    return identify_payload(some);
  };
  EXPECT_EQ(with(6).missing, "");
  EXPECT_EQ(with(5).missing, "5 poses, at least 6 are needed");
  EXPECT_NE(with(1).missing, "");
  EXPECT_NE(identify_payload({}).missing, "");
}

TEST(IdentifyPayload, RefusesPosesThatContradictEachOther) {
  std::vector<StaticPose> poses = good_poses();
  poses[3].w_S[0] += 3.0;  // a person leant on the handle
  EXPECT_NE(identify_payload(poses).missing.find("contradict"), std::string::npos);
  poses = good_poses();
  poses[7].w_S[5] += 0.3;
  EXPECT_NE(identify_payload(poses).missing.find("contradict"), std::string::npos);
}

TEST(IdentifyPayload, ReportsThatThereIsNoPayload) {
  std::vector<StaticPose> poses = good_poses();
  for (StaticPose& pose : poses) pose.w_S.setZero();
  EXPECT_NE(identify_payload(poses).missing.find("no weight"), std::string::npos);
}

}  // namespace
}  // namespace hg::identify

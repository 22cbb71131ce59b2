#include "hg/identify/payload_units.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace hg::identify {
namespace {

const Payload kHandle = {.mass = 1.18, .com = {0.004, -0.011, 0.032}};

// The handle in nine directions; readings in units of these sizes.
std::vector<StaticPose> poses_in(double of_a, double of_f, double of_n) {
  std::vector<StaticPose> poses;
  for (const double pitch : {-0.9, 0.0, 0.9}) {
    for (const double roll : {-1.2, 0.0, 1.2}) {
      const Eigen::Matrix3d R = (Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                                    .toRotationMatrix();
      StaticPose pose;
      pose.a_S = R.transpose() * Eigen::Vector3d(0.0, 0.0, 9.81);
      pose.w_S = payload_wrench(kHandle, pose.a_S, {0, 0, 0}, {0, 0, 0});
      pose.a_S /= of_a;
      pose.w_S.head<3>() /= of_f;
      pose.w_S.tail<3>() /= of_n;
      poses.push_back(pose);
    }
  }
  return poses;
}

std::string doubts(double of_f, double of_n, const Payload& expected) {
  const PayloadEstimate found = identify_payload(poses_in(1.0, of_f, of_n));
  EXPECT_EQ(found.missing, "");
  return fmt::format("{}", fmt::join(payload_doubts(found, expected), "\n"));
}

TEST(PayloadUnits, ReadingsInTheirUnitsAreNotDoubted) {
  EXPECT_EQ(doubts(1.0, 1.0, kHandle), "");
  EXPECT_EQ(doubts(1.0, 1.0, {}), "");
  // another handle than that of the drawing
  EXPECT_EQ(doubts(1.0, 1.0, {.mass = 0.7, .com = {0, 0, 0.05}}), "");
}

TEST(PayloadUnits, ForcesAreComparedWithThePayloadOfTheDevice) {
  EXPECT_EQ(doubts(9.80665, 9.80665, kHandle),
            "f: the mass is 0.1203 kg, device.yaml has 1.18 kg; suspected kgf: 1.18 kg");
  EXPECT_EQ(doubts(4.44822, 4.44822, kHandle),
            "f: the mass is 0.2653 kg, device.yaml has 1.18 kg; suspected lbf: 1.18 kg");
  EXPECT_EQ(doubts(1e-3, 1e-3, kHandle),
            "f: the mass is 1180 kg, device.yaml has 1.18 kg; suspected mN: 1.18 kg");
  EXPECT_EQ(doubts(1.0 / 4000, 1.0 / 4000, kHandle),
            "f: the mass is 4720 kg, device.yaml has 1.18 kg; suspected counts of the sensor");
}

TEST(PayloadUnits, ForcesAreComparedWithWhatAPersonHolds) {
  EXPECT_EQ(doubts(1e-3, 1e-3, {}),
            "f: the mass is 1180 kg, more than a person holds; suspected gf: 11.57 kg, or mN: 1.18 "
            "kg, or "
            "counts of the sensor");
}

TEST(PayloadUnits, TorquesAreComparedWithForces) {
  const std::string far =
      "n: the centre of mass is 34.1 m from the sensor, farther than what a "
      "person holds; suspected ";
  EXPECT_EQ(doubts(1.0, 1e-3, {}), far + "Ncm: 0.3407 m, or Nmm: 0.03407 m");
  EXPECT_TRUE(doubts(1.0, 1e-3, kHandle).starts_with(far)) << doubts(1.0, 1e-3, kHandle);
}

TEST(PayloadUnits, AccelerationsAtRestAreThatOfGravity) {
  EXPECT_EQ(acceleration_fault(poses_in(1.0, 1.0, 1.0)), "");
  EXPECT_EQ(acceleration_fault({}), "");
  EXPECT_EQ(
      identify_payload(poses_in(9.81, 1.0, 1.0)).missing,
      "a: 1 m/s^2 in the middle of the poses, expected 9.81 at rest; suspected g: 9.81 m/s^2");
  EXPECT_NE(acceleration_fault(poses_in(3.0, 1.0, 1.0)), "");
}

TEST(PayloadUnits, AWeightOfTheWrongSignIsNamed) {
  EXPECT_NE(identify_payload(poses_in(-1.0, 1.0, 1.0)).missing.find("one has the wrong sign"),
            std::string::npos);
}

}  // namespace
}  // namespace hg::identify

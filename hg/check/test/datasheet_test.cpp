#include "hg/check/datasheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hg/workspace/test/cartesian_device.h"

namespace hg::check {
namespace {

constexpr workspace::SurveyOptions kFew = {.seed = 3, .postures = 2'000, .positions = 100'000};

TEST(Datasheet, OfAnotherSeedIsNearlyTheSame) {
  const config::DeviceConfig device = workspace::cartesian_device();
  workspace::SurveyOptions other = kFew;
  other.seed = 4;
  const Datasheet a = make_datasheet(device, workspace::survey(device, kFew)),
                  b = make_datasheet(device, workspace::survey(device, other));
  EXPECT_NE(a.condition_median, b.condition_median);
  EXPECT_NEAR(a.condition_median, b.condition_median, 0.05 * a.condition_median);
}

// f <= rating / 1 along each axis; pz carries 5 kg
TEST(Datasheet, ForcesOfACartesianDeviceAreItsRatingsLessGravity) {
  const config::DeviceConfig device = workspace::cartesian_device();
  const Datasheet sheet = make_datasheet(device, workspace::survey(device, kFew));
  EXPECT_NEAR(sheet.force.median, std::min(80.0, 120.0 - 5.0 * 9.81), 1e-9);
  EXPECT_NEAR(sheet.force.smallest, sheet.force.median, 1e-9);
  EXPECT_EQ(sheet.force_bottleneck.joint, "pz");
  EXPECT_NEAR(sheet.torque.median, 7.0, 1e-9);
  EXPECT_EQ(sheet.torque_bottleneck.joint, "rx");
  EXPECT_NEAR(sheet.acceleration.median, 10.0, 1e-9);
  EXPECT_NEAR(sheet.joints[2].gravity_max, 5.0 * 9.81, 1e-9);
  EXPECT_EQ(sheet.joints[0].gravity_max, 0.0);
}

TEST(Datasheet, HasNoForceWhereAJointHasNoRating) {
  std::string urdf(workspace::kCartesianUrdf);
  urdf.replace(urdf.find("effort=\"80\""), 11, "effort=\"0\"");
  const config::DeviceConfig device = workspace::cartesian_device({}, urdf);
  const Datasheet sheet = make_datasheet(device, workspace::survey(device, kFew));
  EXPECT_FALSE(sheet.has_ratings);
  EXPECT_EQ(sheet.unrated, std::vector<std::string>{"py"});
}

TEST(Datasheet, DoesNotChangeWhenTheDeviceIsTurnedAboutTheVertical) {
  const Pose turned = {Eigen::Vector3d(0.3, -0.2, 0.5),
                       Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix()};
  const config::DeviceConfig plain = workspace::cartesian_device(),
                             moved = workspace::cartesian_device(turned);
  const Datasheet a = make_datasheet(plain, workspace::survey(plain, kFew));
  const Datasheet b = make_datasheet(moved, workspace::survey(moved, kFew));
  EXPECT_NEAR(a.force.median, b.force.median, 1e-9);
  EXPECT_NEAR(a.torque.low, b.torque.low, 1e-9);
  EXPECT_NEAR(a.acceleration.median, b.acceleration.median, 1e-9);
  EXPECT_NEAR(a.singular_value.median, b.singular_value.median, 1e-9);
}

}  // namespace
}  // namespace hg::check

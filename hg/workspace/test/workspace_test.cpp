#include "hg/workspace/workspace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/workspace/test/cartesian_device.h"

namespace hg::workspace {
namespace {

constexpr SurveyOptions kFew = {.seed = 3, .postures = 2'000, .positions = 100'000};

CartesianLimit box(const DeviceModel& model) {
  CartesianLimit limit = {.name = "hand", .frame = model.handle, .axes = {}};
  limit.axes[0] = {.q_min = 0.0, .q_max = 4.0, .dq_max = 1.0, .ddq_max = 5.0};
  limit.axes[1] = {.q_min = 0.0, .q_max = 1.0, .dq_max = 1.0, .ddq_max = 5.0};
  limit.axes[2] = {.q_min = 0.0, .q_max = 1.0, .dq_max = 1.0, .ddq_max = 5.0};
  return limit;
}

TEST(Workspace, OfThreePrismaticAxesIsTheProductOfTheirRanges) {
  const config::DeviceConfig device = cartesian_device();
  const HandleWorkspace space = workspace(device, survey(device, kFew));
  EXPECT_NEAR(space.volume, 3.0 * 1.5 * 1.0, 1e-9);
  EXPECT_TRUE(space.bounds.isApprox(
      Eigen::AlignedBox3d(Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(2, 1.5, 1)), 1e-9));
  EXPECT_FALSE(space.has_box);
}

TEST(Workspace, SharesOfABoxThatIsHalfOutOfReach) {
  config::DeviceConfig device = cartesian_device();
  device.model.cartesian_limits.push_back(box(device.model));
  const HandleWorkspace space = workspace(device, survey(device, kFew));
  EXPECT_NEAR(space.box_volume, 4.0, 1e-12);
  EXPECT_NEAR(space.share_any, 0.5, 0.02);
  // the wrist turns about the handle: every position is reached in the nominal orientation
  EXPECT_NEAR(space.share_nominal, 0.5, 0.05);
  EXPECT_NEAR(space.volume, 2.0, 0.1);
}

// At a fixed tilt the height follows from q4 alone: 0.42 m (cos 0.2 - cos 2.45) of the 0.95 m, and
// near one side of the box the forearm keeps the elbow from following the hand.
TEST(Workspace, OfTheHapticGiantInOneOrientationIsAPartOfItsBox) {
  const config::DeviceConfig device = config::load_device("models/haptic_giant/device.yaml");
  const HandleWorkspace space = workspace(device, survey(device));
  const double height = 0.42 * (std::cos(0.2) - std::cos(2.45)) / 0.95;
  EXPECT_GT(space.share_any, 0.97);
  EXPECT_LT(space.share_nominal, height);
  EXPECT_GT(space.share_nominal, height * (1.0 - 0.54 / 3.9) - 0.05);
}

TEST(Workspace, VoxelsAtTheEdgeOfABallCountHalf) {
  const Eigen::AlignedBox3d cube(Eigen::Vector3d::Constant(-1.2), Eigen::Vector3d::Constant(1.2));
  VoxelGrid grid(cube, 0.1);
  constexpr int kSteps = 240;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const Eigen::Vector3d p =
            Eigen::Vector3d(i, j, k) * 2.4 / kSteps - Eigen::Vector3d::Constant(1.2);
        if (p.norm() <= 1.0) grid.touch(p);
      }
    }
  }
  EXPECT_NEAR(grid.volume(), 4.0 / 3.0 * M_PI, 0.03 * 4.0 / 3.0 * M_PI);
}

TEST(Survey, SameSeedSameNumbers) {
  const config::DeviceConfig device = cartesian_device();
  const Survey first = survey(device, kFew), again = survey(device, kFew);
  ASSERT_EQ(first.postures.size(), again.postures.size());
  EXPECT_EQ(first.postures.back().q, again.postures.back().q);
}

}  // namespace
}  // namespace hg::workspace

#include "hg/simulator/moving_base.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/core/error.h"
#include "hg/core/rotation.h"

namespace hg::simulator {
namespace {

constexpr double kDt = 1e-3;

MovingBaseConfig ship() {
  return {.T_B_A = {{0.4, -0.2, 0.6}, Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).matrix()},
          .p_about = {0.1, 0.2, -2.0},
          .swings = {{SwingDirection::kX, 0.1, 5.0, 1.0},
                     {SwingDirection::kZ, 0.05, 3.0, 0.0},
                     {SwingDirection::kRx, 0.1, 4.0, 2.0},
                     {SwingDirection::kRy, 0.08, 6.0, 0.5},
                     {SwingDirection::kRz, 0.06, 7.0, 0.0}}};
}

// Velocity and acceleration are those of the poses, also while the motion begins and ends.
TEST(MovingBase, TwistAndAccelerationAreTheChangesOfThePose) {
  MovingBase base(ship(), kDt);
  TwinBase before = base.step(true, false);
  Vector6 twist_error = Vector6::Zero(), acceleration_error = Vector6::Zero();
  for (int k = 0; k < 12000; ++k) {
    const TwinBase now = base.step(k < 8000, false);
    Vector6 moved;
    moved << now.T_B_A.p - before.T_B_A.p, rotation_between(before.T_B_A.R, now.T_B_A.R);
    const Vector6 mean = 0.5 * (now.twist + before.twist);
    twist_error = twist_error.cwiseMax((moved / kDt - mean).cwiseAbs());
    const Vector6 change = (now.twist - before.twist) / kDt - before.acceleration;
    acceleration_error = acceleration_error.cwiseMax(change.cwiseAbs());
    before = now;
  }
  EXPECT_LT(twist_error.maxCoeff(), 1e-5);
  EXPECT_LT(acceleration_error.maxCoeff(), 3e-3);
}

TEST(MovingBase, BeginsAtItsPlacementAndRestsWhileTheDeviceDoes) {
  MovingBase base(ship(), kDt);
  const TwinBase first = base.step(false, false);
  EXPECT_TRUE(first.T_B_A.p.isApprox(ship().T_B_A.p, 1e-14));
  EXPECT_TRUE(first.twist.isZero(0.0));
  for (int k = 0; k < 3000; ++k) base.step(true, false);
  for (int k = 0; k < 201; ++k) base.step(false, false);
  const TwinBase stopped = base.step(false, false);
  EXPECT_TRUE(stopped.twist.isZero(0.0));
  EXPECT_FALSE(stopped.T_B_A.p.isApprox(ship().T_B_A.p, 1e-3));
  // where the twin then cannot be at the handle, it is where the device starts again
  const TwinBase again = (base.step(false, true), base.step(false, false));
  EXPECT_TRUE(again.T_B_A.p.isApprox(ship().T_B_A.p, 1e-12));
}

TEST(MovingBase, RefusesWhatNoPersonIsCarriedBy) {
  MovingBaseConfig config = ship();
  config.swings = {{SwingDirection::kX, 1.0, 1.0, 0.0}};
  EXPECT_THROW(MovingBase(config, kDt), SetupError);
  config.swings = {{SwingDirection::kX, 0.1, 0.0, 0.0}};
  EXPECT_THROW(MovingBase(config, kDt), SetupError);
  config.swings = {{SwingDirection::kX, std::nan(""), 1.0, 0.0}};
  EXPECT_THROW(MovingBase(config, kDt), SetupError);
}

}  // namespace
}  // namespace hg::simulator

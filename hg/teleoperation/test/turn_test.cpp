#include "hg/teleoperation/turn.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "hg/core/random.h"

namespace hg::teleoperation {
namespace {

constexpr double kLever = 0.1;

Eigen::Matrix3d turned(const Eigen::Vector3d& turn) {
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
}

Eigen::Vector3d any(Random& random, double most) {
  return {random.between(-most, most), random.between(-most, most), random.between(-most, most)};
}

TEST(Turn, StaysAsItIsWhenItIsCoupledWhateverTheLeadersOrientation) {
  Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector3d x = kLever * any(random, 1.7);
    const Eigen::Matrix3d R = turned(any(random, 3.0));
    Turn turn(kLever);
    turn.begin(R, x);
    turn.follow(R);
    ASSERT_LT((turn.x() - x).norm(), 1e-9) << k;
  }
}

TEST(Turn, FollowsTheLeaderAboutTheSameAxisFromWhereBothWere) {
  Turn turn(kLever);
  const Eigen::Matrix3d R = turned({0.3, -1.2, 0.4});
  turn.begin(R, Eigen::Vector3d(0.05, 0.0, 0.0));
  const Eigen::Vector3d more(0.0, 0.0, 0.6);
  turn.follow(turned(more) * R);
  const Eigen::Matrix3d wanted = turned(more) * turned({0.5, 0.0, 0.0});
  EXPECT_LT((turned(turn.x() / kLever) - wanted).norm(), 1e-9);
}

TEST(Turn, SpeedIsTheRateOfItsCoordinates) {
  Random random(2);
  for (int k = 0; k < 100; ++k) {
    Turn turn(kLever);
    const Eigen::Matrix3d R = turned(any(random, 2.0));
    turn.begin(R, kLever * any(random, 1.7));
    turn.follow(R);
    const Eigen::Vector3d before = turn.x(), omega = any(random, 1.0);
    const Eigen::Vector3d speed = turn.speed(omega);
    constexpr double kStep = 1e-6;  // s
    turn.follow(turned(kStep * omega) * R);
    ASSERT_LT(((turn.x() - before) / kStep - speed).norm(), 1e-5) << k;
  }
}

TEST(Turn, NeitherTakesNorGivesPower) {
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    Turn turn(kLever);
    const Eigen::Matrix3d R = turned(any(random, 2.0));
    turn.begin(R, kLever * any(random, 1.7));
    turn.follow(R);
    const Eigen::Vector3d omega = any(random, 1.0), torque = any(random, 5.0);
    const Eigen::Vector3d force = turn.force(torque);
    ASSERT_NEAR(force.dot(turn.speed(omega)), torque.dot(omega), 1e-9) << k;
    ASSERT_LT((turn.torque(force) - torque).norm(), 1e-9) << k;
  }
}

TEST(Turn, ContinuesBeyondHalfATurn) {
  Turn turn(1.0);
  turn.begin(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
  for (int k = 1; k <= 400; ++k) {
    turn.follow(turned({0.0, 0.01 * k, 0.0}));
    ASSERT_NEAR(turn.x().y(), 0.01 * k, 1e-6);
  }
}

}  // namespace
}  // namespace hg::teleoperation

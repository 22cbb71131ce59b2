#include "hg/controller/safety/collision/distance.h"

#include <coal/distance.h>
#include <coal/shape/geometric_shapes.h>
#include <gtest/gtest.h>

#include <random>

#include "hg/core/allocation_counter.h"

namespace hg::collision {
namespace {

Shape capsule(double radius, double half_length) {
  return {.name = "capsule", .frame = 0, .radius = radius, .half_length = half_length};
}
Shape box(const Eigen::Vector3d& half) {
  return {.name = "box", .frame = 0, .half_edges = half, .is_box = true};
}

Pose random_pose(std::mt19937& random, double spread) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Eigen::Quaterniond q(u(random), u(random), u(random), u(random));
  return {spread * Eigen::Vector3d(u(random), u(random), u(random)),
          q.normalized().toRotationMatrix()};
}

coal::Transform3s transform(const Pose& pose) { return {pose.R, pose.p}; }

TEST(Distance, OfCapsuleAndBoxIsThatOfCoal) {
  const unsigned seed = 7;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const coal::Capsule coal_capsule(0.07, 0.8);
  const coal::Box coal_box(0.2, 0.6, 1.2);
  const coal::ComputeDistance exact(&coal_capsule, &coal_box);
  const Distance distance(capsule(0.07, 0.4), box({0.1, 0.3, 0.6}));
  const Distance swapped(box({0.1, 0.3, 0.6}), capsule(0.07, 0.4));
  int apart = 0;
  for (int i = 0; i < 5000; ++i) {
    const Pose a = random_pose(random, 1.5);
    const Pose b = random_pose(random, 0.5);
    coal::DistanceResult result;
    const double expected = exact(transform(a), transform(b), coal::DistanceRequest(), result);
    const double got = distance(a, b);
    EXPECT_EQ(got, swapped(b, a));
    if (expected > 1e-3) {
      ++apart;
      EXPECT_NEAR(got, expected, 1e-5) << "case " << i;
    } else {
      EXPECT_LT(got, 2e-3) << "case " << i;
    }
  }
  EXPECT_GT(apart, 2000);
}

TEST(Distance, OfBallsIsThatOfTheirCentres) {
  const Distance distance(capsule(0.1, 0.0), capsule(0.2, 0.0));
  EXPECT_NEAR(distance({}, {.p = {0.0, 3.0, 4.0}, .R = Eigen::Matrix3d::Identity()}), 4.7, 1e-12);
  EXPECT_NEAR(distance({}, {.p = {0.0, 0.0, 0.25}, .R = Eigen::Matrix3d::Identity()}), -0.05,
              1e-12);
}

TEST(Distance, OfTwoBoxesIsNeverTooLarge) {
  const unsigned seed = 8;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const coal::Box first(0.4, 0.5, 0.6);
  const coal::Box second(3.0, 0.2, 0.1);
  const coal::ComputeDistance exact(&first, &second);
  const Distance distance(box({0.2, 0.25, 0.3}), box({1.5, 0.1, 0.05}));
  for (int i = 0; i < 2000; ++i) {
    const Pose a = random_pose(random, 1.5);
    const Pose b = random_pose(random, 0.5);
    coal::DistanceResult result;
    const double expected = exact(transform(a), transform(b), coal::DistanceRequest(), result);
    if (expected > 0.0) {
      EXPECT_LE(distance(a, b), expected + 1e-6);
      EXPECT_GE(distance(a, b), expected - 0.4);
    }
  }
}

TEST(Distance, AllocatesNothing) {
  std::mt19937 random(9);
  const std::vector<Distance> distances = {{capsule(0.07, 0.4), box({0.1, 0.3, 0.6})},
                                           {capsule(0.07, 0.4), capsule(0.05, 0.2)},
                                           {capsule(0.07, 0.0), capsule(0.05, 0.2)},
                                           {box({0.2, 0.2, 0.2}), box({0.1, 0.3, 0.6})}};
  double sum = 0.0;
  const AllocationCounter allocations;
  for (int i = 0; i < 1000; ++i) {
    const Pose a = random_pose(random, 0.5);
    for (const Distance& distance : distances) sum += distance(a, {});
  }
  EXPECT_EQ(allocations.count(), 0U);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace hg::collision

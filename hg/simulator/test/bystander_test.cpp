#include "hg/simulator/plant/bystander.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hg/simulator/test/plant_setup.h"

namespace hg::simulator {
namespace {

BystanderConfig chest_in_the_way() {
  return {.part = find_body_part("chest"),
          .position = Eigen::Vector3d(1.0, 0.0, 0.0),
          .facing = Eigen::Vector3d(-2.0, 0.0, 0.0)};
}

// A mass that flies against a body: the source's two masses with a spring between them.
struct Impact {
  double force, speed;  // largest; of the mass afterwards
};
Impact impact_of(double mass, double speed, const BystanderConfig& config) {
  constexpr double kStep = 0.25e-3;
  Bystander bystander(config);
  Eigen::Vector3d p(0.99, 0.0, 0.0), v(speed, 0.0, 0.0);
  Impact impact = {0.0, 0.0};
  for (int k = 0; k < 4000; ++k) {
    v += kStep / mass * bystander.step(kStep, p);
    p += kStep * v;
    impact.force = std::max(impact.force, bystander.report().force);
  }
  impact.speed = v.x();
  return impact;
}

TEST(Bystander, IsTheTwoMassModelOfTheSource) {
  BystanderConfig config = chest_in_the_way();
  const double mass = 10.0, speed = 0.5, k = config.part->stiffness, m = config.part->mass;
  const Impact free = impact_of(mass, speed, config);
  EXPECT_NEAR(free.force, speed * std::sqrt(k * mass * m / (mass + m)), 0.2);
  EXPECT_NEAR(free.speed, speed * (mass - m) / (mass + m), 2e-3);
  config.is_clamped = true;
  const Impact clamped = impact_of(mass, speed, config);
  EXPECT_NEAR(clamped.force, speed * std::sqrt(k * mass), 0.2);
  EXPECT_NEAR(clamped.speed, -speed, 2e-3);
}

TEST(Bystander, ReportsForcePressureAndCompression) {
  BystanderConfig config = chest_in_the_way();
  config.is_clamped = true;
  Bystander bystander(config);
  EXPECT_TRUE(bystander.step(1e-3, {0.9, 0.0, 0.0}).isZero());
  const Eigen::Vector3d force = bystander.step(1e-3, {1.004, 0.02, 0.0});
  EXPECT_NEAR(force.x(), -100.0, 1e-9);
  EXPECT_EQ(force.tail<2>().norm(), 0.0);
  EXPECT_NEAR(bystander.report().force, 100.0, 1e-9);
  EXPECT_NEAR(bystander.report().compression, 0.004, 1e-12);
  EXPECT_NEAR(bystander.report().pressure, 10.0, 1e-9);  // 10 cm^2
}

TEST(Bystander, MeetsOnlyWhatComesFromTheFront) {
  Bystander bystander(chest_in_the_way());
  // behind the skin from the start, and beside it
  EXPECT_TRUE(bystander.step(1e-3, {1.1, 0.0, 0.0}).isZero());
  EXPECT_TRUE(bystander.step(1e-3, {0.9, 0.5, 0.0}).isZero());
  EXPECT_TRUE(bystander.step(1e-3, {1.01, 0.0, 0.0}).isZero());
  EXPECT_TRUE(bystander.step(1e-3, {0.99, 0.0, 0.0}).isZero());
  EXPECT_FALSE(bystander.step(1e-3, {1.01, 0.0, 0.0}).isZero());
}

// A whole arm swings against a clamped chest: it pays for all that the body stores.
TEST(Bystander, ThePlantPaysForTheImpact) {
  const model::ChainModel chain = haptic_giant();
  for (const bool is_clamped : {false, true}) {
    PlantConfig config = reference_config();
    model::ChainData posture(chain);
    VectorQ q = VectorQ::Zero(8);
    q.tail(6) = config.q_m_start;
    posture.update_poses(q);
    const int elbow = chain.frame("elbow");
    config.bystander =
        BystanderConfig{.part = find_body_part("chest"),
                        .frame = elbow,
                        .position = posture.pose(elbow).p + Eigen::Vector3d(0.0, 0.02, 0.0),
                        .facing = Eigen::Vector3d(0.0, -1.0, 0.0),
                        .is_clamped = is_clamped};
    Plant plant(config, chain, chain.frame("handle"));
    PlantInput input = idle(config, false);
    const VectorM weight = plant.truth().tau_J;
    double error = plant.energy().sum(), force = 0.0;
    error = -error;
    for (int k = 0; k < 1200; ++k) {
      input.tau_command = weight;
      input.tau_command[0] += 40.0;
      plant.step(input);
      const PlantPower power = plant.power();
      error += config.step * (power.taken() - power.put_in());
      force = std::max(force, plant.truth().bystander.force);
      EXPECT_LT(plant.residual(), 1e-11);
    }
    error += plant.energy().sum();
    EXPECT_GT(force, 30.0);
    EXPECT_LT(std::abs(error), 0.05) << is_clamped;
  }
}

}  // namespace
}  // namespace hg::simulator

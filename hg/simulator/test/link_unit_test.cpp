#include "hg/simulator/sensors/link_unit.h"

#include <gtest/gtest.h>

#include "hg/core/stacked.h"
#include "hg/simulator/plant/ideal_plant.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::simulator {
namespace {

constexpr double kStep = 0.25e-3, kPeriod = 1e-3;

// without errors, noise and delay
LinkUnitConfig ideal() {
  LinkUnitConfig config;
  config.accelerometer = config.gyroscope = {};
  config.filter = {.average = 0.0, .delay = 0.0};
  return config;
}

Vector6 shown(const LinkUnitConfig& config, const BodyMotion& link, std::uint64_t seed = 1,
              int which = 0) {
  LinkUnit unit(config, kStep, kPeriod, seed, which);
  unit.observe(link);
  return unit.sample(0.0);
}

TEST(LinkUnit, ShowsGravityAtRestTurnedByItsMounting) {
  const Vector6 first = shown(ideal(), {}), second = shown(ideal(), {}, 1, 1);
  EXPECT_NEAR(first.head<3>().norm(), 9.81, 1e-12);
  EXPECT_GT((first - second).norm(), 0.1);
  EXPECT_GT((first - shown(ideal(), {}, 2)).norm(), 0.1);
  EXPECT_EQ(first, shown(ideal(), {}));
  LinkUnitConfig straight = ideal();
  straight.is_turned = false;
  EXPECT_LT((shown(straight, {}).head<3>() - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-12);
}

TEST(LinkUnit, FeelsTheLeverFromTheOriginOfItsLink) {
  LinkUnitConfig config = ideal();
  config.is_turned = false;
  const auto beyond_rest = [&](const BodyMotion& link) {
    return Eigen::Vector3d((shown(config, link) - shown(config, {})).head<3>());
  };
  // alpha x p about z and x determines p; the centripetal acceleration has to fit it
  BodyMotion about_z, about_x, turning;
  about_z.acceleration[5] = 1.0;
  about_x.acceleration[3] = 1.0;
  const Eigen::Vector3d z = beyond_rest(about_z), x = beyond_rest(about_x);
  const Eigen::Vector3d p(z.y(), -z.x(), x.y() == 0.0 ? 0.0 : -x.y());
  EXPECT_GT(p.norm(), 0.02);
  const Eigen::Vector3d omega(2.0, -1.0, 3.0);
  turning.twist.tail<3>() = omega;
  EXPECT_LT((beyond_rest(turning) - omega.cross(omega.cross(p))).norm(), 1e-12);
  EXPECT_LT((shown(config, turning).tail<3>() - omega).norm(), 1e-12);
  config.place = 0.0;
  EXPECT_LT(beyond_rest(about_z).norm(), 1e-12);
}

TEST(LinkUnit, OfAPlantMovesAsTheHandleOfTheTruth) {
  const model::ChainModel chain = haptic_giant();
  const PlantConfig config = reference_config();
  const int handle = chain.frame("handle");
  Plant plant(config, chain, handle);
  PlantInput input = idle(config, false);
  input.w_H << 20.0, -10.0, 30.0, 1.0, 2.0, -1.0;
  input.dq_p_command << 0.3, -0.2;
  for (int k = 0; k < 200; ++k) plant.step(input);
  const BodyMotion motion = plant.motion(handle);
  EXPECT_GT(motion.acceleration.norm(), 0.1);
  EXPECT_LT((motion.acceleration - plant.truth().acceleration).norm(), 1e-9);
  EXPECT_LT((motion.twist - plant.truth().twist).norm(), 1e-12);

  IdealPlant ideal_plant({.q_p_start = config.q_p_start, .q_m_start = config.q_m_start}, chain,
                         handle);
  CommandFrame command;
  command.q_m = config.q_m_start;
  command.dq_m = command.ddq_m = VectorM::Constant(6, 0.5);
  command.dq_p = VectorP::Constant(2, 0.1);
  ideal_plant.step(command, true);
  const BodyMotion led = ideal_plant.motion(handle);
  EXPECT_LT((led.acceleration - ideal_plant.truth().acceleration).norm(), 1e-9);
}

}  // namespace
}  // namespace hg::simulator

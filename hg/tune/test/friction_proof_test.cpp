#include <gtest/gtest.h>

#include <algorithm>

#include "hg/config/torque_loop.h"
#include "hg/core/linear_algebra.h"
#include "hg/scenario/assembly.h"
#include "hg/tune/proof.h"
#include "hg/tune/tuned_device.h"

namespace hg::tune {
namespace {

constexpr double kPresliding = 1e-4;  // rad, of all joints

config::SimulatedDeviceConfig reference() {
  return config::load_simulated_device("models/haptic_giant/device.yaml");
}

LoopDevice with_presliding(double presliding) {
  LoopDevice device = device_of(reference());
  for (ActuatorModel& actuator : device.loop.device.actuators) actuator.presliding = presliding;
  return device;
}

VectorM bristles(const LoopDevice& device, double share) {
  VectorM stiffness(device.loop.device.n_m);
  for (int i = 0; i < device.loop.device.n_m; ++i) {
    stiffness[i] = share * presliding_stiffness(device.loop.device.actuators[i]);
  }
  return stiffness;
}

// Largest radius with a body of 6 kg in all hands, bristles `real` times and friction fed forward
// `fed` times as stiff as nominal.
double worst(LoopDevice device, double real, double fed, int postures) {
  device.loop.config.friction_share = fed;
  const tracking::TruePlant plant = {device.loop.device.actuators, device.loop.config.loop, 1.0,
                                     bristles(device, real)};
  double largest = 0.0;
  for (const Eigen::VectorXd& q : config::random_postures(reference().model, postures, 1)) {
    for (const Grasp& grasp : grasps({})) {
      largest =
          std::max(largest, spectral_radius(linearise(device, plant, {}, grasp.hand, {}, q).A));
    }
  }
  return largest;
}

// docs/concepts/control.md, "Friction"
TEST(FrictionProof, HoldsWhereAboutAsMuchIsFedForwardAsIsThere) {
  const LoopDevice device = with_presliding(kPresliding);
  const auto postures = config::random_postures(reference().model, 5, 1);
  const Demands demands(device.loop, {}, postures);
  int cases = 0;
  for (std::size_t i = 0; i < postures.size(); ++i) {
    for (const Case& one : demands.cases(i)) {
      if (!demands.is_friction(one)) continue;
      ++cases;
      EXPECT_LT(demands.excess(device, one), 0.0) << demands.name(one);
    }
  }
  EXPECT_EQ(cases, 5 * 9 * 6);
}

TEST(FrictionProof, DoesNotHoldFarFromThat) {
  const LoopDevice device = with_presliding(kPresliding);
  EXPECT_GT(worst(device, 1.0, 0.0, 2), 1.0) << "nothing fed forward against bristles";
  EXPECT_GT(worst(device, 1.0, 2.0, 2), 1.0) << "twice as much as is there";
  EXPECT_GT(worst(device, 0.0, 1.0, 2), 1.0) << "fed forward against nothing";
}

// friction that changes its sign with the speed is a negative damper in small motions
TEST(FrictionProof, WithoutPreslidingSmallMotionsAreNotStableAlone) {
  LoopDevice device = device_of(reference());
  const tracking::ControlConfig& config = device.loop.config;
  const tracking::TruePlant plant = {device.loop.device.actuators, config.loop};
  for (ActuatorModel& actuator : device.loop.device.actuators) {
    actuator.viscous_friction +=
        actuator.coulomb_friction * actuator.stiction / config.friction_speed;
  }
  const Eigen::VectorXd q = config::random_postures(reference().model, 1, 1).front();
  EXPECT_GT(spectral_radius(linearise(device, plant, {}, grasps({}).back().hand, {}, q).A), 1.01);
}

TEST(FrictionProof, RequiresNothingOfADeviceWithoutPresliding) {
  EXPECT_TRUE(deviations_in_friction(device_of(reference()).loop).empty());
}

// what is linearised does not slip, however small its presliding
TEST(FrictionProof, IsOfTheStiffnessAlone) {
  const double wide = worst(with_presliding(1e-3), 1.0, 1.0, 1);
  LoopDevice steep = with_presliding(1e-5);
  for (ActuatorModel& actuator : steep.loop.device.actuators) actuator.coulomb_friction *= 0.01;
  EXPECT_NEAR(worst(steep, 1.0, 1.0, 1), wide, 1e-6);
}

}  // namespace
}  // namespace hg::tune

#include "hg/design/device_design.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "hg/core/error.h"
#include "hg/core/scratch_folder.h"
#include "hg/design/design_problem.h"
#include "hg/model/chain_data.h"

namespace hg::design {
namespace {

const DesignProblem& problem() {
  static const DesignProblem problem = load_problem("models/design/haptic_giant.yaml");
  return problem;
}

DeviceDesign made(const DesignVariables& variables) {
  return make_device(problem().base, problem().catalogue, variables, "Made");
}

DesignVariables other() {
  DesignVariables variables = problem().base.variables;
  variables.lengths = {.L1 = 0.45, .L2 = 0.60, .D3 = 0.65, .L4 = 0.50, .D6 = 0.14};
  variables.size[3] = problem().catalogue.size("7005");
  variables.ratio[1] = 3;
  variables.gantry_x = 5.2;
  variables.mount_height = 2.05;
  return variables;
}

Eigen::VectorXd posture() {
  return (Eigen::VectorXd(8) << 0.3, -0.2, 0.4, 1.2, -0.5, 1.1, 0.3, -0.7).finished();
}

// Mass matrices, which hold lengths and masses.
Eigen::MatrixXd mass_matrix(const DeviceModel& device) {
  model::ChainData chain(device.chain);
  chain.update(posture(), Eigen::VectorXd::Zero(8));
  return chain.M();
}

TEST(DeviceDesign, TheVariablesOfTheBaseGiveTheBase) {
  const DeviceModel& base = problem().base.device.model;
  const DeviceModel same = made(problem().base.variables).device.model;
  // of the gantry's mass matrix nothing is a variable
  EXPECT_LT((mass_matrix(same) - mass_matrix(base)).cwiseAbs().maxCoeff(), 1e-6);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(same.joint_limits[i].dq_max, base.joint_limits[i].dq_max, 1e-9);
    EXPECT_NEAR(same.joint_limits[i].ddq_max, base.joint_limits[i].ddq_max, 1e-9);
    EXPECT_NEAR(same.actuators[i].torque_max, base.actuators[i].torque_max, 1e-9);
    EXPECT_NEAR(same.actuators[i].rotor_inertia, base.actuators[i].rotor_inertia, 1e-9);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(same.cartesian_limits[k].axes[axis].q_max,
                base.cartesian_limits[k].axes[axis].q_max);
    }
  }
}

TEST(DeviceDesign, WrittenFilesLoadAsTheSameDeviceWithTheSameMetrics) {
  const DeviceDesign design = made(other());
  const ScratchFolder folder;
  design.files.write(folder.path());
  const config::DeviceConfig loaded =
      config::load_device(std::filesystem::path(folder.path()) / "device.yaml");
  EXPECT_EQ(mass_matrix(loaded.model), mass_matrix(design.device.model));
  const HumanCapability human =
      human_capability(human_arm(Sex::kMale, 50), {.samples = 20'000, .poses = 50});
  const DeviceMetrics a = measure(design.device.model, human, metric_options(design.device));
  const DeviceMetrics b = measure(loaded.model, human, metric_options(loaded));
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.force.low, b.force.low);
  EXPECT_NEAR(b.moving_mass, design.moving_mass, 1e-6);
}

TEST(DeviceDesign, HasTheLengthsThatWereAskedFor) {
  const DeviceModel device = made(other()).device.model;
  const auto lengths = model::haptic_giant::lengths_of(device.chain, device.handle);
  EXPECT_NEAR(lengths.L1, 0.45, 1e-6);
  EXPECT_NEAR(lengths.L2, 0.60, 1e-6);
  EXPECT_NEAR(lengths.D3, 0.65, 1e-6);
  EXPECT_NEAR(lengths.L4, 0.50, 1e-6);
  EXPECT_NEAR(lengths.D6, 0.14, 1e-6);
}

TEST(DeviceDesign, RefusesALinkThatIsTooShortForItsJoints) {
  DesignVariables variables = problem().base.variables;
  variables.lengths.L4 = 0.15;
  EXPECT_THROW(made(variables), SetupError);
}

TEST(DeviceDesign, ALargerRatioGivesTorqueForSpeed) {
  const JointSize& size = problem().catalogue.sizes[2];
  const ActuatorModel slow = with_ratio(size, 2 * size.gear_ratio);
  EXPECT_EQ(slow.speed_full_torque, size.actuator.speed_full_torque / 2);
  EXPECT_EQ(slow.rotor_inertia, size.actuator.rotor_inertia * 4);
  EXPECT_EQ(slow.torque_max, size.gear_torque_max);  // what the gear can take
}

TEST(DesignProblem, SizesNeverGrowTowardsTheHand) {
  std::vector<double> point = to_point(problem().base.variables);
  const std::vector<double> sizes = {0, 4, 2, 1, 3, 2};
  std::copy(sizes.begin(), sizes.end(), point.begin() + kContinuous.size());
  const DesignVariables variables = to_variables(problem(), point);
  EXPECT_EQ(variables.size, (std::array<int, 6>{4, 3, 2, 2, 1, 0}));
}

}  // namespace
}  // namespace hg::design

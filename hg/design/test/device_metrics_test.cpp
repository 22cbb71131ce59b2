#include "hg/design/device_metrics.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "hg/config/device.h"
#include "hg/core/error.h"
#include "hg/core/random.h"
#include "hg/model/chain_data.h"

namespace hg::design {
namespace {

using std::numbers::pi;

const config::DeviceConfig& haptic_giant() {
  static const config::DeviceConfig device = config::load_device("models/haptic_giant/device.yaml");
  return device;
}

const HumanCapability& human() {
  static const HumanCapability capability =
      human_capability(human_arm(Sex::kMale, 50.0), {.samples = 50'000, .poses = 200});
  return capability;
}

DeviceMetrics measured(const DeviceModel& device, const HumanCapability& hand = human()) {
  MetricOptions options = metric_options(haptic_giant());
  options.keeps_poses = true;
  return measure(device, hand, options);
}

// A hand that the device covers completely: tiny ellipsoids, one pose in the middle of its range.
HumanCapability weak_hand() {
  HumanCapability weak = human();
  for (HandPose& pose : weak.poses) {
    for (Eigen::Matrix3d* S :
         {&pose.velocity, &pose.turn_velocity, &pose.acceleration, &pose.turn_acceleration}) {
      *S = 1e-6 * Eigen::Matrix3d::Identity();
    }
  }
  return weak;
}

TEST(DeviceMetrics, ReachedPosesAreThePosesOfTheHandWithinAllLimits) {
  const DeviceModel& device = haptic_giant().model;
  const DeviceMetrics metrics = measured(device);
  const MetricOptions options = metric_options(haptic_giant());
  model::ChainData chain(device.chain);
  int reached = 0;
  for (std::size_t i = 0; i < human().poses.size(); ++i) {
    const PoseMetrics& pose = metrics.each[i];
    if (!pose.is_reached) continue;
    ++reached;
    chain.update_poses(pose.q);
    const Pose is = chain.pose(device.handle);
    const Pose& hand = human().poses[i].T_F_hand;
    EXPECT_NEAR(is.p.z(), hand.p.z() + options.floor_z, 1e-9);
    // the grip (x of the handle) towards the thumb, z of the handle towards the forearm; the person
    // may face any way
    EXPECT_NEAR(is.R(2, 0), hand.R(2, 2), 1e-9);
    EXPECT_NEAR(is.R(2, 2), -hand.R(2, 0), 1e-9);
    for (int k = 0; k < device.n_m; ++k) {
      EXPECT_GE(pose.q[2 + k], device.joint_limits[k].q_min);
      EXPECT_LE(pose.q[2 + k], device.joint_limits[k].q_max);
    }
    const double s = pose.q[5] + pose.q[6];
    EXPECT_GE(s, device.virtual_joints[0].limits.q_min);
    EXPECT_LE(s, device.virtual_joints[0].limits.q_max);
  }
  EXPECT_EQ(metrics.reached, reached);
  EXPECT_NEAR(metrics.pose, reached / 200.0, 1e-12);
  EXPECT_GT(reached, 20);
}

// The closed form against the numerical inverse kinematics of the same chain: with m1 limited to
// (almost) a turn the device is no HapticGiant to measure().
TEST(DeviceMetrics, ClosedFormReachesWhatTheNumericalSolutionReaches) {
  HumanCapability few = human();
  few.poses.resize(12);
  DeviceModel device = haptic_giant().model;
  EXPECT_TRUE(closed_form(device));
  const DeviceMetrics closed = measured(device, few);
  device.joint_limits[0].q_min = -3.2;
  device.joint_limits[0].q_max = 3.2;
  device.posture = VectorM::Constant(6, std::nan(""));
  device.posture[1] = pi / 2;
  EXPECT_FALSE(closed_form(device));
  const DeviceMetrics numerical = measured(device, few);
  for (std::size_t i = 0; i < few.poses.size(); ++i) {
    EXPECT_EQ(closed.each[i].is_reached, numerical.each[i].is_reached) << i;
  }
}

TEST(DeviceMetrics, AWeakHandIsCoveredWhereverItIsReached) {
  const DeviceMetrics metrics = measured(haptic_giant().model, weak_hand());
  EXPECT_NEAR(metrics.velocity, metrics.pose, 1e-9);
  EXPECT_NEAR(metrics.turn_velocity, metrics.pose, 1e-9);
  EXPECT_NEAR(metrics.acceleration, metrics.pose, 1e-9);
  EXPECT_NEAR(metrics.turn_acceleration, metrics.pose, 1e-9);
}

TEST(DeviceMetrics, FasterJointsCoverMoreAndStrongerOnesHoldMore) {
  const DeviceMetrics before = measured(haptic_giant().model);
  DeviceModel device = haptic_giant().model;
  for (ActuatorModel& actuator : device.actuators) actuator.torque_max *= 2.0;
  const DeviceMetrics stronger = measured(device);
  EXPECT_GT(stronger.acceleration, before.acceleration);
  EXPECT_EQ(stronger.velocity, before.velocity);
  for (limits::JointLimits& joint : device.joint_limits) joint.dq_max *= 0.5;
  EXPECT_LT(measured(device).velocity, before.velocity);
}

// Force in the worst direction against a search: in 2000 random directions no motor exceeds its
// torque at that force, and some motor does at 5 % more in the worst of them.
TEST(DeviceMetrics, ForceIsHeldInEveryDirectionAndInTheWorstOnlyJust) {
  const DeviceModel& device = haptic_giant().model;
  const DeviceMetrics metrics = measured(device);
  model::ChainData chain(device.chain);
  Random random(5);
  int judged = 0;
  for (const PoseMetrics& pose : metrics.each) {
    if (!pose.is_reached || judged == 10) continue;
    ++judged;
    chain.update(pose.q, Eigen::VectorXd::Zero(8));
    const Eigen::MatrixXd J = chain.jacobian(device.handle).rightCols(6).topRows(3);
    double used = 0.0;
    for (int i = 0; i < 2000; ++i) {
      Eigen::Vector3d n;
      for (double& x : n) x = random.between(-1.0, 1.0);
      const Eigen::VectorXd torques = J.transpose() * (pose.force * n.normalized());
      for (int k = 0; k < 6; ++k) {
        const double available =
            device.chain.joints()[2 + k].effort_max - std::abs(chain.gravity()[2 + k]);
        used = std::max(used, std::abs(torques[k]) / available);
      }
    }
    EXPECT_LE(used, 1.0 + 1e-9);
    EXPECT_GT(used, 0.95);
  }
  EXPECT_EQ(judged, 10);
}

// One of the elastic joints alone, all others made rigid: the first mode is that of its spring and
// of the inertia behind it, M(i, i).
TEST(DeviceMetrics, FirstModeOfOneElasticJointIsThatOfItsSpring) {
  DeviceModel device = haptic_giant().model;
  for (int i = 0; i < 6; ++i) device.actuators[i].stiffness = i == 3 ? 500.0 : 1e9;
  const DeviceMetrics metrics = measured(device);
  model::ChainData chain(device.chain);
  for (const PoseMetrics& pose : metrics.each) {
    if (!pose.is_reached) continue;
    chain.update(pose.q, Eigen::VectorXd::Zero(8));
    EXPECT_NEAR(pose.frequency, std::sqrt(500.0 / chain.M()(5, 5)) / (2 * pi),
                1e-3 * pose.frequency);
  }
  EXPECT_NEAR(metrics.frequency_clamped,
              std::sqrt(500.0 / device.actuators[3].rotor_inertia) / (2 * pi), 1e-9);
}

TEST(DeviceMetrics, CoverageOfBallsIsTheRatioOfTheirRadii) {
  const auto directions = half_sphere(64);
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  EXPECT_NEAR(relative_coverage(0.25 * I, I, directions), 0.5, 1e-12);
  EXPECT_NEAR(relative_coverage(4.0 * I, I, directions), 1.0, 1e-12);
  const Eigen::Matrix3d flat = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  EXPECT_EQ(relative_coverage(flat, I, directions), 0.0);
  // half as long along one axis: the mean of min(1, radius) over the sphere, by integration
  const Eigen::Matrix3d oblate = Eigen::Vector3d(1.0, 1.0, 0.25).asDiagonal();
  double mean = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double z = (i + 0.5) / 1000;
    mean += 1.0 / std::sqrt(1.0 - z * z + z * z / 0.25) / 1000;
  }
  EXPECT_NEAR(relative_coverage(oblate, I, half_sphere(500)), mean, 2e-3);
}

TEST(DeviceMetrics, MovingMassIsThatOfThePaper) {
  EXPECT_NEAR(metric_options(haptic_giant()).moving_mass, 36.8, 1e-9);  // [HG] III-C
}

TEST(DeviceMetrics, NothingToMeasureIsRefused) {
  HumanCapability none = human();
  none.poses.clear();
  EXPECT_THROW(measure(haptic_giant().model, none), SetupError);
  EXPECT_THROW(measure(haptic_giant().model, human(), {.directions = 0}), SetupError);
}

}  // namespace
}  // namespace hg::design

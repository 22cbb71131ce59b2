#include "hg/identify/static_poses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hg/config/simulation/simulation.h"
#include "hg/core/error.h"

namespace hg::identify {
namespace {

const config::SimulatedDeviceConfig& reference_device() {
  static const config::SimulatedDeviceConfig device =
      config::load_simulated_device("models/haptic_giant/device.yaml");
  return device;
}

TEST(StaticPostures, StayWithinTheLimitsAndShowGravityFromManySides) {
  const config::SimulatedDeviceConfig& device = reference_device();
  const std::vector<VectorM> postures = static_postures(device, 12);
  ASSERT_EQ(postures.size(), 12u);
  std::vector<StaticPose> poses;
  for (const VectorM& q_m : postures) {
    for (int i = 0; i < 6; ++i) {
      const limits::JointLimits& joint = device.model.joint_limits[i];
      EXPECT_GE(q_m[i], joint.q_min);
      EXPECT_LE(q_m[i], joint.q_max);
    }
    const double sum = device.model.virtual_joints[0].weights.dot(q_m);
    EXPECT_GE(sum, device.model.virtual_joints[0].limits.q_min);
    EXPECT_LE(sum, device.model.virtual_joints[0].limits.q_max);
    model::ChainData chain(device.model.chain);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(8);
    q.tail(6) = q_m;
    chain.update_poses(q);
    const Eigen::Vector3d p_B_H = chain.pose(device.model.handle).p;
    EXPECT_LT(std::abs(p_B_H.x()), 1.65);
    EXPECT_LT(std::abs(p_B_H.y()), 1.95);
    StaticPose pose;
    pose.a_S = (chain.pose(device.model.handle).R * device.model.T_H_S.R).row(2).transpose() * 9.81;
    poses.push_back(pose);
  }
  EXPECT_LT(identify_payload(poses).condition, 2.0);
  EXPECT_EQ(static_postures(device, 12), postures);
}

TEST(SimulatedPoses, ShowThePayloadOfTheDevice) {
  const config::SimulatedDeviceConfig& device = reference_device();
  const Payload& configured = device.estimation.wrench.payload;
  ASSERT_GT(configured.mass, 0.0);
  std::vector<StaticPose> poses;
  for (const VectorM& q_m : static_postures(device, 8)) {
    poses.push_back(measure_simulated(device, q_m));
  }
  const PayloadEstimate found = identify_payload(poses);
  EXPECT_EQ(found.missing, "");
  // gain errors of the sensors (0.5 %) and cross-talk are part of what is found
  EXPECT_NEAR(found.mass, configured.mass, 0.02 * configured.mass);
  EXPECT_LT((found.com - configured.com).norm(), 2e-3);
}

std::string refusal(const std::string& text) {
  try {
    read_static_poses("poses.csv", text);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReadStaticPoses, TakesColumnsByNameAndAveragesAPose) {
  const std::vector<StaticPose> poses =
      read_static_poses("poses.csv",
                        "pose, n_x,n_y,n_z,f_x,f_y,f_z,a_x,a_y,a_z,remark\r\n"
                        "left,1,2,3,4,5,6,7,8,9,first\n"
                        "left,3,2,3,4,5,6,7,8,11,\n"
                        "\n"
                        "right,0,0,0,0,0,-1e1,0,0,9.81,x\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].a_S, Eigen::Vector3d(7, 8, 10));
  EXPECT_EQ(poses[0].w_S, (Vector6() << 4, 5, 6, 2, 2, 3).finished());
  EXPECT_EQ(poses[1].w_S[2], -10.0);
}

TEST(ReadStaticPoses, WithoutPosesEveryRowIsOne) {
  const std::string header = "a_x,a_y,a_z,f_x,f_y,f_z,n_x,n_y,n_z\n";
  EXPECT_EQ(read_static_poses("p", header + "1,2,3,4,5,6,7,8,9\n1,2,3,4,5,6,7,8,9\n").size(), 2u);
}

TEST(ReadStaticPoses, TakesTablesOfSpreadsheets) {
  const std::string header = "a_x,a_y,a_z,f_x,f_y,f_z,n_x,n_y,n_z", row = "1.5,2,3,4,5,6,7,8,9";
  const auto with = [](std::string text, char separator) {
    std::ranges::replace(text, ',', separator);
    return text;
  };
  std::string decimal = with(row, ';');
  decimal.replace(decimal.find('.'), 1, ",");
  std::string lines_of_old = header + "\n" + row + "\n";
  std::ranges::replace(lines_of_old, '\n', '\r');
  EXPECT_EQ(read_static_poses("poses.csv", lines_of_old).size(), 1u);
  const std::string quoted = "\"a_x\",\"a_y\",a_z,f_x,f_y,f_z,n_x,n_y,n_z";
  for (const std::string& text :
       {header + "\n" + row, with(header, ';') + "\r\n" + decimal + "\r\n",
        with(header, ';') + "\n" + with(row, ';'), with(header, '\t') + "\n" + with(row, '\t'),
        "\xef\xbb\xbf" + header + "\n" + row, quoted + "\n\"1.5\",2,3,4,5,6,7,8,9"}) {
    const std::vector<StaticPose> poses = read_static_poses("poses.csv", text);
    ASSERT_EQ(poses.size(), 1u) << text;
    EXPECT_EQ(poses[0].a_S, Eigen::Vector3d(1.5, 2, 3)) << text;
    EXPECT_EQ(poses[0].w_S[5], 9.0) << text;
  }
}

TEST(ReadStaticPoses, ReportsWhatIsWrongAndWhere) {
  const std::string header = "a_x,a_y,a_z,f_x,f_y,f_z,n_x,n_y,n_z\n";
  EXPECT_EQ(refusal(header), "poses.csv:1: expected rows of readings below the header");
  EXPECT_EQ(refusal(header + "1,2,3,4e160,5,6,7,8,9\n"),
            "poses.csv:2: f_x: expected a reading of at most 1e+06, got 4e+160");
  EXPECT_EQ(refusal("a_x,a_y,a_z,f_x,f_y,fz,n_x,n_y,n_z\n"),
            "poses.csv:1: f_z: there is no such column, nearest is 'fz'; needs a_x, a_y, a_z, f_x, "
            "f_y, f_z, n_x, n_y, n_z");
  EXPECT_EQ(refusal(header + "1,2,3,4,5,6,7,8,9\n1,2,3,4,5,6,7,8\n"),
            "poses.csv:3: expected 9 values as in the first line, got 8");
  EXPECT_EQ(refusal(header + "1,2,3,4,five,6,7,8,9\n"),
            "poses.csv:2: f_y: expected a number, got 'five'");
  EXPECT_EQ(refusal(header + "1,2,3,4,nan,6,7,8,9\n"),
            "poses.csv:2: f_y: expected a number, got 'nan'");
}

}  // namespace
}  // namespace hg::identify

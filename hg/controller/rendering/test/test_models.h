/// Models that the tests of the rendering share: the HapticGiant and twins without files of config.
#pragma once

#include <cmath>
#include <string>

#include "hg/controller/rendering/rendering.h"

namespace hg::rendering {

/// The HapticGiant without any limits; tests add the ones they are about.
inline DeviceModel unlimited_device() {
  DeviceModel device{
      .chain = model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf"),
      .n_p = 2,
      .n_m = 6};
  device.handle = device.chain.frame("handle");
  device.elbow = device.chain.frame("elbow");
  device.gantry_range.resize(2);
  device.joint_limits.assign(6, {});
  return device;
}

/// A twin with one TwinDof per degree of freedom of `chain`, without limits.
inline TwinModel unlimited_twin(model::ChainModel chain, const std::string& end_effector) {
  TwinModel twin{.chain = std::move(chain)};
  twin.end_effector = twin.chain.frame(end_effector);
  twin.q_start = twin.chain.neutral();
  for (const model::Joint& joint : twin.chain.joints()) {
    for (int i = 0; i < joint.nv; ++i) {
      TwinDof dof;
      dof.name = joint.name;
      dof.q_index = joint.nv == 1 ? joint.q_index : -1;
      twin.dofs.push_back(dof);
    }
  }
  return twin;
}

/// What estimation gives: gantry at rest at `q_p`, wrench `w_H`.
inline RobotState robot_with(const Eigen::Vector2d& q_p, const VectorM& q_m, const Vector6& w_H) {
  RobotState robot;
  robot.q_m = q_m;
  robot.dq_m = VectorM::Zero(q_m.size());
  robot.q_p = q_p;
  robot.dq_p = VectorP::Zero(2);
  robot.ddq_p = VectorP::Zero(2);
  robot.w_H = w_H;
  return robot;
}

/// Where H is for a posture.
inline Pose handle_pose(const DeviceModel& device, const Eigen::Vector2d& q_p, const VectorM& q_m) {
  model::ChainData chain(device.chain);
  Eigen::VectorXd q(8);
  q << q_p, q_m;
  chain.update_kinematics(q, Eigen::VectorXd::Zero(8));
  return chain.pose(device.handle);
}

/// Coordinates of a floating joint at `pose`.
inline ConfigurationA floating_at(const Pose& pose) {
  const Eigen::Quaterniond quaternion(pose.R);
  ConfigurationA q(7);
  q << pose.p, quaternion.coeffs();
  return q;
}

/// Without synchronisation: the twin need not be where the handle is.
inline RenderingOptions without_synchronisation() {
  RenderingOptions options;
  options.kP_tran = options.kD_tran = options.kP_rot = options.kD_rot = 0.0;
  return options;
}

inline VectorM posture(std::initializer_list<double> q) {
  return Eigen::Map<const Eigen::VectorXd>(q.begin(), static_cast<Eigen::Index>(q.size()));
}

}  // namespace hg::rendering

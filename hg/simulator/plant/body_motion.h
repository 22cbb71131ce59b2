/// Motion of a link of a simulated machine, and the inertial quantities at a point of it.
#pragma once

#include "hg/core/types.h"
#include "hg/model/chain_data.h"

namespace hg::simulator {

/// Motion of a link's frame L, resolved in B, linear part first.
struct BodyMotion {
  Eigen::Matrix3d R_B_L = Eigen::Matrix3d::Identity();
  Vector6 twist = Vector6::Zero();         ///< m/s, rad/s
  Vector6 acceleration = Vector6::Zero();  ///< acceleration of L's origin, m/s^2; angular, rad/s^2
};

/// Motion of `frame` with the joint accelerations `ddq` (nv); `chain`: after update_kinematics().
template <typename Accelerations>
BodyMotion motion_of(const model::ChainData& chain, int frame, const Accelerations& ddq) noexcept {
  BodyMotion motion = {.R_B_L = chain.pose(frame).R,
                       .twist = chain.twist(frame),
                       .acceleration = chain.bias_acceleration(frame)};
  motion.acceleration.noalias() += chain.jacobian(frame).lazyProduct(ddq);
  return motion;
}

/// Quantities that inertial sensors measure in a frame S fixed to a link, resolved in S.
struct InertialMotion {
  Eigen::Vector3d a;      ///< acceleration minus gravity, m/s^2
  Eigen::Vector3d omega;  ///< angular velocity, rad/s
  Eigen::Vector3d alpha;  ///< angular acceleration, rad/s^2
};

inline InertialMotion felt_at(const Pose& T_L_S, const BodyMotion& link) noexcept {
  // fixed to the link: same angular motion, further terms by the lever arm
  const Eigen::Vector3d gravity_B(0.0, 0.0, -9.81);
  const Eigen::Matrix3d R_S_B = (link.R_B_L * T_L_S.R).transpose();
  const Eigen::Vector3d p_L_S_in_S = T_L_S.R.transpose() * T_L_S.p;
  InertialMotion felt;
  felt.omega = R_S_B * link.twist.tail<3>();
  felt.alpha = R_S_B * link.acceleration.tail<3>();
  felt.a = R_S_B * (link.acceleration.head<3>() - gravity_B) + felt.alpha.cross(p_L_S_in_S) +
           felt.omega.cross(felt.omega.cross(p_L_S_in_S));
  return felt;
}

}  // namespace hg::simulator

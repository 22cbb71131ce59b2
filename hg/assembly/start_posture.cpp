#include "hg/assembly/start_posture.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "hg/core/error.h"
#include "hg/model/haptic_giant.h"

namespace hg::assembly {
namespace {

// throws SetupError when the device may not be at `start`
void check_limits(const config::Scenario& scenario, const Start& start) {
  const rendering::DeviceModel& device = scenario.device.model;
  const auto require = [&](const std::string& item, double value,
                           const limits::JointLimits& limits) {
    if (value >= limits.q_min && value <= limits.q_max) return;
    throw SetupError(fmt::format(
        "twin {}: at its start {} of the device would be at {:.3f}, outside {:.3f} .. {:.3f}; move "
        "or turn the twin's placement",
        scenario.twin.name, item, value, limits.q_min, limits.q_max));
  };
  for (int i = 0; i < device.n_m; ++i) {
    require("joint " + device.manipulator_joint(i), start.q_m[i],
            device.joint_limits[static_cast<std::size_t>(i)]);
  }
  for (const rendering::VirtualJoint& joint : device.virtual_joints) {
    require(joint.name, joint.weights.dot(start.q_m), joint.limits);
  }

  model::Chain chain = device.chain;
  Eigen::VectorXd q(chain.nq());
  q << start.q_p, start.q_m;
  chain.update_kinematics(q, Eigen::VectorXd::Zero(chain.nv()));
  for (const rendering::CartesianLimit& limit : device.cartesian_limits) {
    const Eigen::Vector3d p = chain.pose(limit.frame).p;
    for (int axis = 0; axis < 3; ++axis) {
      require(limit.name + " " + "xyz"[axis], p[axis], limit.axes[static_cast<std::size_t>(axis)]);
    }
  }
}

}  // namespace

Pose handle_start(const rendering::TwinModel& twin) {
  model::Chain chain = twin.chain;
  chain.update_kinematics(twin.q_start, VectorA::Zero(chain.nv()));
  return chain.pose(twin.end_effector);
}

Start find_start(const config::Scenario& scenario) {
  Start start;
  start.T_B_H = handle_start(scenario.twin.model);
  const auto require_solved = [&](model::haptic_giant::InverseStatus status, const char* what) {
    if (status == model::haptic_giant::InverseStatus::kSolved) return;
    const Eigen::Vector3d& p = start.T_B_H.p;
    throw SetupError(
        fmt::format("twin {}: {} its handle at ({:.2f}, {:.2f}, {:.2f}) m: {}; move the "
                    "twin's placement",
                    scenario.twin.name, what, p.x(), p.y(), p.z(), to_string(status)));
  };
  Eigen::Vector2d q_p;
  Vector6 q_m;
  require_solved(model::haptic_giant::inverse_at_target(start.T_B_H, q_p, q_m),
                 "the device cannot reach");
  for (int i = 0; i < 2; ++i) {
    const Interval range = scenario.device.prepositioning.q_limits[static_cast<std::size_t>(i)];
    q_p[i] = std::clamp(q_p[i], range.lb, range.ub);
  }
  require_solved(model::haptic_giant::inverse(start.T_B_H, q_p, {}, q_m),
                 "the gantry's reach ends before");
  start.q_p = q_p;
  start.q_m = q_m;
  check_limits(scenario, start);
  return start;
}

}  // namespace hg::assembly

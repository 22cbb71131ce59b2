#include "hg/assembly/start_posture.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

#include "hg/core/error.h"
#include "hg/model/haptic_giant.h"
#include "hg/model/inverse_kinematics.h"

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
        "or turn the twin's placement, or change its start{}",
        scenario.twin.name, item, value, limits.q_min, limits.q_max,
        scenario.device.kinematics == config::Kinematics::kGeneric ? " or the device's posture"
                                                                   : ""));
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

Start closed_form_start(const config::Scenario& scenario) {
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
  return start;
}

Interval range_of(const limits::JointLimits& limits) { return {limits.q_min, limits.q_max}; }

// The joints that stand at a limit in `q`, for advice.
std::string joints_at_limits(const model::Chain& chain, const model::InverseProblem& problem,
                             const Eigen::VectorXd& q) {
  constexpr double kAtLimit = 1e-6;  // rad and m
  std::string names;
  for (int i = 0; i < q.size(); ++i) {
    if (q[i] - problem.q_min[i] > kAtLimit && problem.q_max[i] - q[i] > kAtLimit) continue;
    (names += names.empty() ? "" : ", ") += chain.joints()[static_cast<std::size_t>(i)].name;
  }
  return names.empty() ? "the arm is stretched or folded" : "at their limits: " + names;
}

Start numeric_start(const config::Scenario& scenario) {
  const rendering::DeviceModel& device = scenario.device.model;
  const int n_p = device.n_p, n = device.chain.nv();
  Start start;
  start.T_B_H = handle_start(scenario.twin.model);
  model::InverseProblem problem = {
      .frame = device.handle,
      .T_B_frame = start.T_B_H,
      .q_min = Eigen::VectorXd(n),
      .q_max = Eigen::VectorXd(n),
      .goal = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN())};
  for (int i = 0; i < n; ++i) {
    const Interval range =
        i < n_p ? scenario.device.prepositioning.q_limits[static_cast<std::size_t>(i)]
                : range_of(device.joint_limits[static_cast<std::size_t>(i - n_p)]);
    problem.q_min[i] = range.lb;
    problem.q_max[i] = range.ub;
  }
  if (device.posture.size() > 0) problem.goal.tail(device.n_m) = device.posture;

  const model::InverseResult found = model::inverse_kinematics(device.chain, problem);
  if (!found.is_solved) {
    const Eigen::Vector3d& p = start.T_B_H.p;
    throw SetupError(fmt::format(
        "twin {}: the device cannot hold its handle at ({:.2f}, {:.2f}, {:.2f}) m: the nearest "
        "posture is {:.3f} m and {:.3f} rad away, {}; move or turn the twin's placement, or change "
        "its start",
        scenario.twin.name, p.x(), p.y(), p.z(), found.position_error, found.angle_error,
        joints_at_limits(device.chain, problem, found.q)));
  }
  start.q_p = found.q.head(n_p);
  start.q_m = found.q.tail(device.n_m);
  return start;
}

}  // namespace

Pose handle_start(const rendering::TwinModel& twin) {
  model::Chain chain = twin.chain;
  chain.update_kinematics(twin.q_start, VectorA::Zero(chain.nv()));
  return chain.pose(twin.end_effector);
}

Start find_start(const config::Scenario& scenario) {
  Start start = scenario.device.kinematics == config::Kinematics::kHapticGiant
                    ? closed_form_start(scenario)
                    : numeric_start(scenario);
  check_limits(scenario, start);
  return start;
}

}  // namespace hg::assembly

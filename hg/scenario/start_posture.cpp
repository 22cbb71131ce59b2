#include "hg/scenario/start_posture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "hg/controller/safety/collision/distance.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/error.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/model/haptic_giant.h"
#include "hg/model/inverse_kinematics.h"

namespace hg::scenario {
namespace {

// One limited quantity of the device that is outside its range.
struct Violation {
  std::string item;
  double value;
  limits::JointLimits limits;
};

// The first limit, in the order of the catalogue, that forbids `q` (gantry first). Moves `chain`,
// the device, to `q`.
std::optional<Violation> find_violation(const DeviceModel& device, model::ChainData& chain,
                                        const Eigen::VectorXd& q) {
  const auto is_outside = [](double value, const limits::JointLimits& limits) {
    return value < limits.q_min || value > limits.q_max;
  };
  const auto q_m = q.tail(device.n_m);
  for (int i = 0; i < device.n_m; ++i) {
    const limits::JointLimits& limits = device.joint_limits[i];
    if (is_outside(q_m[i], limits)) {
      return Violation{"joint " + device.manipulator_joint(i), q_m[i], limits};
    }
  }
  for (const VirtualJoint& joint : device.virtual_joints) {
    const double sum = joint.weights.dot(q_m);
    if (is_outside(sum, joint.limits)) return Violation{joint.name, sum, joint.limits};
  }
  chain.update_kinematics(q, Eigen::VectorXd::Zero(chain.model().nv()));
  for (const CartesianLimit& limit : device.cartesian_limits) {
    const Eigen::Vector3d p = chain.pose(limit.frame).p;
    for (int axis = 0; axis < 3; ++axis) {
      const limits::JointLimits& limits = limit.axes[axis];
      if (is_outside(p[axis], limits)) {
        return Violation{limit.name + " " + "xyz"[axis], p[axis], limits};
      }
    }
  }
  return {};
}

// throws StartError when the device may not be at `start`
void check_limits(const config::DeviceConfig& device, const config::Twin& twin,
                  const Start& start) {
  model::ChainData chain(device.model.chain);
  const std::optional<Violation> violation =
      find_violation(device.model, chain, stacked(start.q_p, start.q_m));
  if (!violation) return;
  const std::string why =
      fmt::format("{} of the device would be at {:.3f}, outside {:.3f} .. {:.3f}", violation->item,
                  violation->value, violation->limits.q_min, violation->limits.q_max);
  throw StartError(
      fmt::format("twin {}: at its start {}; move or turn the twin's placement, or change its "
                  "start{}",
                  twin.name, why, !device.model.has_closed_form ? " or the device's posture" : ""),
      device, twin, why);
}

// throws StartError when the handle or a part of the device would be in the floor at `start`: the
// guard accepts a device in its present posture, so no other check reports it
void check_floor(const config::DeviceConfig& device, const config::Twin& twin, const Start& start) {
  if (!device.has_floor) return;
  const auto refuse = [&](const std::string& what) {
    throw StartError(
        fmt::format("twin {}: at its start {} would be in the floor, at floor_z_m {:g} of the "
                    "device; check the sign of floor_z_m, or move the twin's placement",
                    twin.name, what, device.floor_z),
        device, twin, what + " would be in the floor");
  };
  if (start.T_B_H.p.z() <= device.floor_z) {
    refuse(fmt::format("the handle, at z {:.3f} m,", start.T_B_H.p.z()));
  }
  model::ChainData chain(device.model.chain);
  chain.update_poses(stacked(start.q_p, start.q_m));
  const auto pose = [&](const collision::Shape& shape) {
    return shape.frame < 0 ? Pose{} : chain.pose(shape.frame);
  };
  for (const collision::Pair& pair : device.collision.pairs.watched) {
    const collision::Shape& a = device.collision.shapes[pair.a];
    const collision::Shape& b = device.collision.shapes[pair.b];
    if (!a.is_surrounding && !b.is_surrounding) continue;
    if (collision::Distance(a, b)(pose(a), pose(b)) > 0.0) continue;
    refuse((a.is_surrounding ? b : a).name + " of the device");
  }
}

Start closed_form_start(const config::DeviceConfig& device, const config::Twin& twin) {
  Start start;
  start.T_B_H = handle_start(twin.model);
  const auto require_solved = [&](model::haptic_giant::InverseStatus status, const char* what) {
    if (status == model::haptic_giant::InverseStatus::kSolved) return;
    const Eigen::Vector3d& p = start.T_B_H.p;
    throw StartError(
        fmt::format("twin {}: {} its handle at ({:.2f}, {:.2f}, {:.2f}) m: {}; move the "
                    "twin's placement",
                    twin.name, what, p.x(), p.y(), p.z(), to_string(status)),
        device, twin, std::string(to_string(status)));
  };
  const model::haptic_giant::Lengths lengths =
      model::haptic_giant::lengths_of(device.model.chain, device.model.handle);
  Eigen::Vector2d q_p;
  Vector6 q_m;
  require_solved(model::haptic_giant::inverse_at_target(start.T_B_H, q_p, q_m, {}, lengths),
                 "the device cannot reach");
  for (int i = 0; i < 2; ++i) {
    const Interval range = device.model.gantry_range[i];
    q_p[i] = std::clamp(q_p[i], range.lb, range.ub);
  }
  require_solved(model::haptic_giant::inverse(start.T_B_H, q_p, {}, q_m, lengths),
                 "the gantry's reach ends before");
  start.q_p = q_p;
  start.q_m = q_m;
  return start;
}

Interval range_of(const limits::JointLimits& limits) { return {limits.q_min, limits.q_max}; }

// The joints that stand at a limit in `q`, for advice.
std::string joints_at_limits(const model::ChainModel& chain, const model::InverseProblem& problem,
                             const Eigen::VectorXd& q) {
  constexpr double kAtLimit = 1e-6;  // rad and m
  std::string names;
  for (int i = 0; i < q.size(); ++i) {
    if (q[i] - problem.q_min[i] > kAtLimit && problem.q_max[i] - q[i] > kAtLimit) continue;
    (names += names.empty() ? "" : ", ") += chain.joints()[i].name;
  }
  return names.empty() ? "the arm is stretched or folded" : "at their limits: " + names;
}

Start numeric_start(const config::DeviceConfig& config, const config::Twin& twin) {
  const DeviceModel& device = config.model;
  const collision::Nearest shapes(config.collision.shapes, config.collision.pairs.watched);
  const int n_p = device.n_p, n = device.chain.nv();
  Start start;
  start.T_B_H = handle_start(twin.model);
  model::InverseProblem problem = {
      .frame = device.handle,
      .T_B_frame = start.T_B_H,
      .q_min = Eigen::VectorXd(n),
      .q_max = Eigen::VectorXd(n),
      .goal = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN())};
  for (int i = 0; i < n; ++i) {
    const Interval range =
        i < n_p ? device.gantry_range[i] : range_of(device.joint_limits[i - n_p]);
    problem.q_min[i] = range.lb;
    problem.q_max[i] = range.ub;
  }
  if (device.posture.size() > 0) problem.goal.tail(device.n_m) = device.posture;

  model::ChainData chain(device.chain);
  problem.permits = [&](const Eigen::VectorXd& q) {
    return !find_violation(device, chain, q) && shapes.distance(chain) > 0.0;
  };
  const model::InverseResult found = model::inverse_kinematics(device.chain, problem);
  // what rounded numbers place at a singular posture is beyond it by a hair
  constexpr double kHair = 1e-5;  // m and rad
  const bool is_near = std::max(found.position_error, found.angle_error) < kHair;
  if (!found.is_solved && !(is_near && problem.permits(found.q))) {
    const Eigen::Vector3d& p = start.T_B_H.p;
    throw StartError(
        fmt::format(
            "twin {}: the device cannot hold its handle at ({:.2f}, {:.2f}, {:.2f}) m: the nearest "
            "posture is {:.3f} m and {:.3f} rad away, {}; move or turn the twin's placement, or "
            "change its start",
            twin.name, p.x(), p.y(), p.z(), found.position_error, found.angle_error,
            joints_at_limits(device.chain, problem, found.q)),
        config, twin,
        fmt::format("its nearest posture is {:.2f} m and {:.0f} degrees away", found.position_error,
                    found.angle_error * 180.0 / M_PI));
  }
  // where no solution was permitted, the limits of the nearest one give the reason
  start.q_p = found.q.head(n_p);
  start.q_m = found.q.tail(device.n_m);
  return start;
}

}  // namespace

Pose handle_start(const rendering::TwinModel& twin) {
  model::ChainData chain(twin.chain);
  chain.update_kinematics(twin.q_start, VectorA::Zero(chain.model().nv()));
  return chain.pose(twin.end_effector);
}

Start find_start(const config::DeviceConfig& device, const config::Twin& twin) {
  Start start =
      device.model.has_closed_form ? closed_form_start(device, twin) : numeric_start(device, twin);
  check_limits(device, twin, start);
  check_floor(device, twin, start);
  return start;
}

}  // namespace hg::scenario

#include "hg/controller/rendering/catalogue.h"

#include <algorithm>

#include "hg/core/stacked.h"

namespace hg::rendering {
namespace {

Interval range_of(const limits::JointLimits& limits) { return {limits.q_min, limits.q_max}; }

}  // namespace

LimitCatalogue make_catalogue(const DeviceModel& device, const TwinModel& twin) {
  LimitCatalogue catalogue;
  for (int i = 0; i < device.n_m; ++i) {
    const model::Joint& joint = device.chain.joints()[device.n_p + i];
    catalogue.push_back({LimitKind::kManipulatorJoint, joint.name, !joint.is_slide(),
                         range_of(device.joint_limits[i])});
  }
  for (const VirtualJoint& joint : device.virtual_joints) {
    catalogue.push_back({LimitKind::kVirtualJoint, joint.name, true, range_of(joint.limits)});
  }
  for (std::size_t i = 0; i < device.motors().size(); ++i) {
    const model::Joint& joint = device.chain.joints()[device.n_p + i];
    catalogue.push_back({LimitKind::kMotor, "motor " + joint.name, !joint.is_slide(), {}});
  }
  for (const CartesianLimit& limit : device.cartesian_limits) {
    for (std::size_t axis = 0; axis < limit.axes.size(); ++axis) {
      catalogue.push_back({LimitKind::kCartesian, limit.name + " " + "xyz"[axis], false,
                           range_of(limit.axes[axis])});
    }
  }
  if (device.keeps_apart) {
    catalogue.push_back({LimitKind::kSelfCollision, "self-collision", false, {}});
  }
  for (const TwinDof& dof : twin.dofs) {
    catalogue.push_back({LimitKind::kTwinJoint, dof.name, dof.is_angle, range_of(dof.limits)});
  }
  return catalogue;
}

std::vector<std::string> repeated_names(const LimitCatalogue& catalogue) {
  std::vector<std::string> repeated;
  for (auto limit = catalogue.begin(); limit != catalogue.end(); ++limit) {
    const auto first = std::ranges::find(catalogue, limit->name, &LimitInfo::name);
    if (first != limit) repeated.push_back(limit->name);
  }
  return repeated;
}

LimitPositions::LimitPositions(const DeviceModel& device)
    : virtual_joints_(device.virtual_joints),
      motors_(device.motors().size()),
      keeps_apart_(device.keeps_apart),
      chain_(device.chain) {
  for (const CartesianLimit& limit : device.cartesian_limits) frames_.push_back(limit.frame);
}

void LimitPositions::find(const VectorP& q_p, const VectorM& q_m, std::vector<double>& positions) {
  positions.assign(q_m.begin(), q_m.end());
  for (const VirtualJoint& joint : virtual_joints_) positions.push_back(joint.weights.dot(q_m));
  positions.resize(positions.size() + motors_, 0.0);  // have no position
  chain_.update_poses(stacked(q_p, q_m));
  for (const int frame : frames_) {
    const Eigen::Vector3d p = chain_.pose(frame).p;
    positions.insert(positions.end(), p.begin(), p.end());
  }
  if (keeps_apart_) positions.push_back(0.0);  // has no position
}

}  // namespace hg::rendering

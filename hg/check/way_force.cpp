#include "hg/check/way_force.h"

#include <fmt/format.h>

#include <cmath>

#include "hg/check/wall_force.h"
#include "hg/check/wall_postures.h"
#include "hg/model/capability.h"
#include "hg/model/chain_data.h"

namespace hg::check {
namespace {

bool keep_least(const HeldForce& held, const DeviceModel& device, LeastForce& least) {
  if (held.motor < 0 || held.force >= least.force) return false;
  least.force = held.force;
  least.motor = device.manipulator_joint(held.motor);
  return true;
}

// The worse of pushes to both sides along `way`.
HeldForce held_along(const DeviceModel& device, const model::ChainData& chain,
                     const Eigen::Vector3d& way) {
  const HeldForce there = held_force(device, chain, way), back = held_force(device, chain, -way);
  return there.force < back.force ? there : back;
}

void add_line(const std::string& item, const std::string& what, double force, Collector& out) {
  const bool is_weak = force < model::kPaperForce;
  out.add(is_weak ? Severity::kWarning : Severity::kNote, item,
          what + (is_weak ? ": with more, rule 111 or 324 may stop the device" : ""),
          is_weak ? "push less, or place the twin where the arm is stronger" : "");
}

}  // namespace

WayForces way_forces(const config::DeviceConfig& device, const config::Twin& twin,
                     const workspace::Way& way) {
  const DeviceModel& model = device.model;
  WayForces found;
  if (model.motors().empty()) return found;
  for (const int dof : way.led) found.joints.push_back({.dof = dof});
  WallPostures postures(device);
  const model::ChainData& chain = postures.chain();
  model::ChainData twin_chain(twin.model.chain);
  const VectorA at_rest = VectorA::Zero(twin.model.chain.nv());
  for (const workspace::Place& place : way.places) {
    postures.best_from(place.q, [&] { return held_force(model, chain).force; });
    keep_least(held_force(model, chain), model, found.any);
    twin_chain.update_kinematics(place.q_a, at_rest);
    const model::Jacobian& J = twin_chain.jacobian(twin.model.end_effector);
    for (JointForce& joint : found.joints) {
      const Eigen::Vector3d column = J.col(joint.dof).head<3>();
      if (!(column.norm() > workspace::kNearLever)) continue;
      const Eigen::Vector3d along = column.normalized();
      postures.best_from(place.q, [&] { return held_along(model, chain, along).force; });
      if (!keep_least(held_along(model, chain, along), model, joint)) continue;
      joint.at = place.q_a[twin.model.dofs[joint.dof].q_index];
    }
  }
  std::erase_if(found.joints, [](const JointForce& joint) { return !std::isfinite(joint.force); });
  return found;
}

void inspect_way_forces(const config::DeviceConfig& device, const config::Twin& twin,
                        const workspace::Way& way, Collector& out) {
  const WayForces found = way_forces(device, twin, way);
  for (const JointForce& joint : found.joints) {
    const rendering::TwinDof& dof = twin.model.dofs[joint.dof];
    add_line("joints." + dof.name,
             fmt::format("where it jams or ends, the motors hold a hand of {:.0f} N along its way "
                         "({}, at {:.2f} {})",
                         joint.force, joint.motor, joint.at, dof.is_angle ? "rad" : "m"),
             joint.force, out);
  }
  if (!std::isfinite(found.any.force)) return;
  add_line(
      "placement",
      fmt::format("on the twin's way, the motors hold a hand of {:.0f} N in any direction ({})",
                  found.any.force, found.any.motor),
      found.any.force, out);
}

}  // namespace hg::check

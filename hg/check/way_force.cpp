#include "hg/check/way_force.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/check/wall_force.h"
#include "hg/check/wall_postures.h"
#include "hg/model/capability.h"
#include "hg/model/chain_data.h"

namespace hg::check {
namespace {

constexpr double kLever = 0.02;  // m or 1: below, a joint turns the handle on the spot

void keep_least(const HeldForce& held, const DeviceModel& device, double& least,
                std::string& motor) {
  if (held.motor < 0 || held.force >= least) return;
  least = held.force;
  motor = device.manipulator_joint(held.motor);
}

// The worse of pushes to both sides along `way`.
HeldForce held_along(const DeviceModel& device, const model::ChainData& chain,
                     const Eigen::Vector3d& way) {
  const HeldForce there = held_force(device, chain, way), back = held_force(device, chain, -way);
  return there.force < back.force ? there : back;
}

}  // namespace

std::vector<WayForce> way_forces(const config::DeviceConfig& device, const config::Twin& twin,
                                 const workspace::Way& way) {
  const DeviceModel& model = device.model;
  if (model.motors().empty()) return {};
  WallPostures postures(device);
  model::ChainData chain(twin.model.chain);
  const VectorA at_rest = VectorA::Zero(twin.model.chain.nv());
  std::vector<WayForce> found;
  for (int i = 0; i < std::ssize(twin.model.dofs); ++i) {
    const rendering::TwinDof& dof = twin.model.dofs[i];
    WayForce force = {.twin_joint = dof.name};
    for (const workspace::Place& place : way.places) {
      chain.update_kinematics(place.q_a, at_rest);
      const Eigen::Vector3d column = chain.jacobian(twin.model.end_effector).col(i).head<3>();
      if (!(column.norm() > kLever)) continue;
      const Eigen::Vector3d along = column.normalized();
      const double before = force.along;
      postures.best_from(place.q, [&] { return held_along(model, postures.chain(), along).force; });
      keep_least(held_along(model, postures.chain(), along), model, force.along, force.motor);
      if (force.along < before) force.at = place.q_a[dof.q_index];
      postures.best_from(place.q, [&] { return held_force(model, postures.chain()).force; });
      keep_least(held_force(model, postures.chain()), model, force.any, force.motor_of_any);
    }
    if (std::isfinite(force.along)) found.push_back(force);
  }
  return found;
}

void inspect_way_forces(const config::DeviceConfig& device, const config::Twin& twin,
                        const workspace::Way& way, Collector& out) {
  for (const WayForce& force : way_forces(device, twin, way)) {
    const bool is_weak = std::min(force.along, force.any) < model::kPaperForce;
    out.add(is_weak ? Severity::kWarning : Severity::kNote, "joints." + force.twin_joint,
            fmt::format("where it jams or ends, the motors hold a hand of {:.0f} N along its way "
                        "({}, at {:.2f}), and of {:.0f} N in any direction ({}){}",
                        force.along, force.motor, force.at, force.any, force.motor_of_any,
                        is_weak ? ": with more, rule 111 or 324 may stop the device" : ""),
            is_weak ? "push less, or place the twin where the arm is stronger" : "");
  }
}

}  // namespace hg::check

#include "hg/check/wall_force.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hg/check/wall_postures.h"
#include "hg/controller/rendering/motor_torque.h"
#include "hg/model/capability.h"
#include "hg/workspace/workspace.h"

namespace hg::check {
namespace {

// The limit of the handle that has this wall.
int limit_of(const DeviceModel& device, int axis, bool is_upper) {
  const auto place = [&](const CartesianLimit& limit) {
    if (limit.frame != device.handle) return kInfinity;
    return is_upper ? limit.axes[axis].q_max : -limit.axes[axis].q_min;
  };
  return static_cast<int>(std::ranges::min_element(device.cartesian_limits, {}, place) -
                          device.cartesian_limits.begin());
}

// The box that the handle is kept in: smaller by the margins of its limits, and where it has no
// wall as large as what the device reaches from its own posture.
Eigen::AlignedBox3d rendered_box(const DeviceModel& device, const Eigen::Vector3d& start) {
  constexpr double kOpen = 0.5;  // m to either side
  Eigen::AlignedBox3d box(start.array() - kOpen, start.array() + kOpen);
  for (int axis = 0; axis < 3; ++axis) {
    double lower = -kInfinity, upper = kInfinity;
    for (const CartesianLimit& limit : device.cartesian_limits) {
      if (limit.frame != device.handle) continue;
      lower = std::max(lower, limit.axes[axis].q_min + limit.margin);
      upper = std::min(upper, limit.axes[axis].q_max - limit.margin);
    }
    if (std::isfinite(lower)) box.min()[axis] = lower;
    if (std::isfinite(upper)) box.max()[axis] = upper;
  }
  return box;
}

// Orientations of the handle that are `tilt` (rad) from its own one; a device that carries its arm
// about stands in any direction.
std::vector<Eigen::Matrix3d> orientations(const DeviceModel& device, const Eigen::Matrix3d& own,
                                          double tilt) {
  const int headings = device.has_closed_form ? 4 : 1;
  std::vector<Eigen::Matrix3d> all;
  for (int heading = 0; heading < headings; ++heading) {
    const Eigen::AngleAxisd turn(0.5 * std::numbers::pi * heading, Eigen::Vector3d::UnitZ());
    for (int side = 0; side < (tilt > 0.0 ? 4 : 1); ++side) {
      const double about = 0.5 * std::numbers::pi * side;
      const Eigen::Vector3d axis(std::cos(about), std::sin(about), 0.0);
      all.push_back(turn * Eigen::AngleAxisd(tilt, axis) * own);
    }
  }
  return all;
}

std::vector<Eigen::Vector3d> places_on(const Eigen::AlignedBox3d& box, int axis, bool is_upper) {
  constexpr int kPlaces = 7;  // along each edge
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<Eigen::Vector3d> places;
  for (int row = 0; row < kPlaces; ++row) {
    for (int column = 0; column < kPlaces; ++column) {
      Eigen::Vector3d p;
      p[axis] = is_upper ? box.max()[axis] : box.min()[axis];
      p[u] = std::lerp(box.min()[u], box.max()[u], column / (kPlaces - 1.0));
      p[v] = std::lerp(box.min()[v], box.max()[v], row / (kPlaces - 1.0));
      places.push_back(p);
    }
  }
  return places;
}

WallForce examine(const DeviceModel& device, WallPostures& postures, const Eigen::AlignedBox3d& box,
                  WallForce wall) {
  const auto [axis, is_upper] = std::pair(wall.axis, wall.is_upper);
  const Eigen::Vector3d outward = (is_upper ? 1.0 : -1.0) * Eigen::Vector3d::Unit(axis);
  const auto held = [&] { return held_force(device, postures.chain(), outward); };
  const auto turned = orientations(device, postures.start().R, wall.tilt);
  std::vector<double> forces;
  for (const Eigen::Vector3d& p : places_on(box, axis, is_upper)) {
    double least = kInfinity;
    for (const Eigen::Matrix3d& R : turned) {
      const auto reached = postures.at({p, R});
      if (!reached) continue;
      const Eigen::VectorXd q = postures.best_from(*reached, [&] { return held().force; });
      const auto [force, motor] = held();
      least = std::min(least, force);
      if (motor < 0 || force >= wall.least) continue;
      wall.least = force;
      wall.motor = device.manipulator_joint(motor);
      wall.place = p;
      wall.q = q;
    }
    if (std::isfinite(least)) forces.push_back(least);
  }
  wall.places = static_cast<int>(forces.size());
  if (forces.empty()) return wall;
  const auto middle = forces.begin() + std::ssize(forces) / 2;
  std::ranges::nth_element(forces, middle);
  wall.median = *middle;
  return wall;
}

std::string text_of(const WallForce& wall, const std::string& name) {
  const Eigen::Vector3d& p = wall.place;
  const std::string tilt =
      wall.tilt > 0.0 ? fmt::format(", handle tilted by {:g} rad", wall.tilt) : "";
  return fmt::format("{} holds {:.0f} N ({}, at x {:.2f} y {:.2f} z {:.2f}{}), median {:.0f} N",
                     name, wall.least, wall.motor, p.x(), p.y(), p.z(), tilt, wall.median);
}

// Lever of the handle about each joint of the manipulator, m, or 1 of a slide.
Eigen::Matrix3Xd levers(const DeviceModel& device, const model::ChainData& chain) {
  return chain.jacobian(device.handle).topRows<3>().rightCols(device.n_m);
}

// What a motor has left beside the weight of the device, at rest; without 0 where it does not hold
// the weight.
Interval left_of(const DeviceModel& device, const model::ChainData& chain, int motor) {
  const Interval torque = rendering::allowed_torque(device.motors()[motor], 0.0);
  const double weight = chain.gravity()[device.n_p + motor];
  return {torque.lb - weight, torque.ub - weight};
}

// `used`: the end of `left` that the force goes to.
void keep_least(Interval left, double used, double lever, int motor, HeldForce& held) {
  constexpr double kNoLever = 1e-9;  // m
  const bool holds_weight = left.contains(0.0);
  if (holds_weight && lever < kNoLever) return;
  const double force = holds_weight ? used / lever : 0.0;
  if (force < held.force) held = {force, motor};
}

}  // namespace

HeldForce held_force(const DeviceModel& device, const model::ChainData& chain,
                     const Eigen::Vector3d& direction) {
  const Eigen::VectorXd lever = levers(device, chain).transpose() * direction;
  HeldForce held;
  for (int i = 0; i < device.n_m; ++i) {
    const Interval left = left_of(device, chain, i);
    keep_least(left, lever[i] > 0.0 ? -left.lb : left.ub, std::abs(lever[i]), i, held);
  }
  return held;
}

HeldForce held_force(const DeviceModel& device, const model::ChainData& chain) {
  const Eigen::Matrix3Xd lever = levers(device, chain);
  HeldForce held;
  for (int i = 0; i < device.n_m; ++i) {
    const Interval left = left_of(device, chain, i);
    keep_least(left, std::min(-left.lb, left.ub), lever.col(i).norm(), i, held);
  }
  return held;
}

std::vector<WallForce> wall_forces(const config::DeviceConfig& device) {
  const DeviceModel& model = device.model;
  if (model.motors().empty()) return {};
  WallPostures postures(device);
  const Eigen::AlignedBox3d walls = workspace::handle_box(model);
  const Eigen::AlignedBox3d box = rendered_box(model, postures.start().p);
  constexpr double kTilt = 0.4;  // rad
  constexpr int kTilts = 4;
  std::vector<WallForce> found;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_upper : {false, true}) {
      const double place = (is_upper ? walls.max() : walls.min())[axis];
      if (!std::isfinite(place)) continue;
      WallForce wall = {
          .limit = limit_of(model, axis, is_upper), .axis = axis, .is_upper = is_upper};
      for (int k = 0; k < kTilts && wall.places == 0; ++k) {
        wall.tilt = kTilt * k;
        wall = examine(model, postures, box, wall);
      }
      found.push_back(wall);
    }
  }
  return found;
}

void inspect_wall_forces(const config::DeviceConfig& device, Collector& out) {
  for (const WallForce& wall : wall_forces(device)) {
    const std::string item = fmt::format("cartesian_limits[{}].{}", wall.limit, "xyz"[wall.axis]);
    const std::string name = device.model.cartesian_limits[wall.limit].name + " " + wall.name();
    if (wall.places == 0) {
      out.add(Severity::kNote, item, name + " is not reached with the handle upright or tilted",
              "");
    } else if (wall.least < model::kPaperForce) {
      out.add(Severity::kWarning, item,
              text_of(wall, name) + ": with more, rule 324 closes the brakes",
              "draw the wall in, or push less there");
    } else {
      out.add(Severity::kNote, item, text_of(wall, name), "");
    }
  }
}

}  // namespace hg::check

/// Description of tool.yaml.
#pragma once

#include <string>

#include "hg/config/schema.h"
#include "hg/core/types.h"

namespace hg::config {

/// Content of tool.yaml, before it becomes a Tool.
struct ToolDraft {
  std::string name;
  double mass = 0.0;
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Placement handle, sensor;
  bool has_dead_man = true;
};

template <class V>
void describe(V& v, ToolDraft& d) {
  v.words("name", d.name, "name of the tool", Need::kRequired);
  v.number("mass_kg", d.mass, kNotNegative, "mass of all that is screwed onto the flange");
  v.vector("centre_of_mass_m", d.centre_of_mass, kAnyNumber, "in the link of the flange");
  v.inertia("inertia_kg_m2", d.inertia,
            "about the centre of mass, axes of the flange: [ixx, iyy, izz] or [ixx, iyy, izz, ixy, "
            "ixz, iyz]");
  v.group(
      "handle", [&](auto& child) { describe(child, d.handle); },
      "frame H, held by the user, in the link of the flange");
  v.group(
      "sensor", [&](auto& child) { describe(child, d.sensor); },
      "force/torque sensor S in the handle frame H");
  v.flag("dead_man", d.has_dead_man,
         "whether the handle has a dead-man switch. Without one a hand that lets go is not "
         "detected: the device runs until it is stopped");
}

}  // namespace hg::config

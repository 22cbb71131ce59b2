/// Description of tool.yaml.
#pragma once

#include "hg/config/schema.h"
#include "hg/config/tool.h"

namespace hg::config {

template <class V>
void describe(V& v, Tool& tool) {
  v.words("name", tool.name, "name of the tool", Need::kRequired);
  v.number("mass_kg", tool.body.mass, kNotNegative, "mass of all that is screwed onto the flange");
  v.vector("centre_of_mass_m", tool.body.p_com, kAnyNumber, "in the link of the flange");
  v.inertia("inertia_kg_m2", tool.body.inertia,
            "about the centre of mass, axes of the flange: [ixx, iyy, izz] or [ixx, iyy, izz, ixy, "
            "ixz, iyz]");
  Placement handle, sensor;
  v.group(
      "handle", [&](auto& child) { describe(child, handle); },
      "frame H, held by the user, in the link of the flange");
  v.group(
      "sensor", [&](auto& child) { describe(child, sensor); },
      "force/torque sensor S in the handle frame H");
  tool.body.T_link_handle = pose_of(handle);
  tool.T_H_S = pose_of(sensor);
  v.flag("dead_man", tool.has_dead_man,
         "whether the handle has a dead-man switch. Without one a hand that lets go is not "
         "detected: the device runs until it is stopped");
}

}  // namespace hg::config

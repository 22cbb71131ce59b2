/// A device whose workspace is known exactly: three prismatic axes and a wrist that turns about the
/// handle.
#pragma once

#include <string_view>

#include "hg/config/device.h"

namespace hg::workspace {

inline constexpr std::string_view kCartesianUrdf = R"(<robot name="cartesian">
<link name="base"/>
<joint name="px" type="prismatic"><parent link="base"/><child link="a"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="2" effort="100" velocity="1"/></joint>
<link name="a"><inertial><mass value="4"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="py" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
<limit lower="0" upper="1.5" effort="80" velocity="1"/></joint>
<link name="b"><inertial><mass value="3"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="pz" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
<limit lower="0" upper="1" effort="120" velocity="1"/></joint>
<link name="c"><inertial><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="rz" type="revolute"><parent link="c"/><child link="d"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" effort="9" velocity="1"/></joint>
<link name="d"><inertial><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="ry" type="revolute"><parent link="d"/><child link="e"/><axis xyz="0 1 0"/>
<limit lower="0.3" upper="2.8" effort="8" velocity="1"/></joint>
<link name="e"><inertial><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="rx" type="revolute"><parent link="e"/><child link="handle"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" effort="7" velocity="1"/></joint>
<link name="handle"><inertial><mass value="1"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>)";

/// The root link of `urdf` stands at T_B_root. Every acceleration rating is 10.
inline config::DeviceConfig cartesian_device(const Pose& T_B_root = {},
                                             std::string_view urdf = kCartesianUrdf) {
  config::DeviceConfig device = {.name = "cartesian",
                                 .model = {.chain = model::ChainModel::from_urdf_text(
                                               urdf, "cartesian.urdf", {.T_B_root = T_B_root})}};
  device.model.n_m = 6;
  device.model.handle = device.model.chain.frame("handle");
  for (const model::Joint& joint : device.model.chain.joints()) {
    device.model.joint_limits.push_back({.q_min = joint.position.lb,
                                         .q_max = joint.position.ub,
                                         .dq_max = joint.velocity_max,
                                         .ddq_max = 10.0});
  }
  device.sources = {{"device.yaml", ""}, {"cartesian.urdf", std::string(urdf)}};
  return device;
}

}  // namespace hg::workspace

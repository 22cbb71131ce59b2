/// Devices with given kinds of joints, for the tests of this module.
#pragma once

#include <string>

#include "hg/model/device_model.h"

namespace hg::safety {

/// Two gantry axes and six joints, all of them limited alike. `slides`: which of the eight joints
/// are prismatic, for example "pprrrrrr".
inline DeviceModel device_with(const std::string& slides, const limits::JointLimits& limits) {
  std::string urdf = "<robot name='device'><link name='l0'/>";
  const std::string inertial =
      "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
      "</inertial>";
  for (std::size_t i = 0; i < slides.size(); ++i) {
    const std::string link = std::to_string(i + 1);
    urdf += "<joint name='j" + link + "' type='" + (slides[i] == 'p' ? "prismatic" : "revolute") +
            "'><parent link='l" + std::to_string(i) + "'/><child link='l" + link +
            "'/><axis xyz='0 0 1'/><limit lower='-9' upper='9'/></joint><link name='l" + link +
            "'>" + inertial + "</link>";
  }
  DeviceModel device{.chain = model::ChainModel::from_urdf_text(urdf + "</robot>", "device.urdf"),
                     .n_p = 2,
                     .n_m = 6};
  device.gantry_range.assign(2, {-1.4, 1.4});
  device.joint_limits.assign(6, limits);
  return device;
}

}  // namespace hg::safety

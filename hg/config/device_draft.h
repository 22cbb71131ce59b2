/// A device in the making.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/schema.h"

namespace hg::config {

struct DeviceJoint {
  JointUnit unit = JointUnit::kEither;
  limits::JointLimits limits;
  std::optional<ActuatorModel> actuator;
};

/// A capsule of device.yaml around the shape of a link and of what is fixed to it.
struct LinkCapsule {
  std::string name;
  int link = -1;
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< Ends of its segment in the link, m
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0.0;  ///< m
};

/// Two links, or else two capsules, that are not watched.
struct UnwatchedPair {
  std::vector<int> links, capsules;
};

/// A device in the making: what is known of it so far, and the names and parts it is made from.
struct DeviceDraft {
  /// Its chain comes last
  DeviceConfig device = {.model = {.chain = model::ChainModel::free_body({})}};
  std::filesystem::path tool;
  ChainPart part;
  std::vector<std::string> link_names;  ///< link names of the URDF
  int flange = -1;
  std::vector<std::string> joint_names, frame_names;  ///< names of the chain
  std::vector<DeviceJoint> joints;                    ///< all joints, with the limits of the URDF
  std::vector<int> gantry, manipulator;               ///< indices of joints
  bool has_joints = false;                            ///< both lists are usable
  JointUnit gantry_unit = JointUnit::kEither;
  std::vector<std::string> manipulator_names;
  Placement sensor;
  bool watches_collisions = true;
  std::vector<LinkCapsule> capsules;
  std::vector<UnwatchedPair> unwatched;
};

}  // namespace hg::config

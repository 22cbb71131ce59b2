/// Gripper at the end of a URDF: joints that open and shut, and that no arm is moved by.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/model/urdf.h"

namespace hg::new_files {

struct Gripper {
  std::string link;                 ///< Link that carries it: the last one that the arm moves
  std::vector<std::string> joints;  ///< Its moving joints
};

/// The gripper of a robot whose other joints are one chain; none where nothing looks like one.
/// A joint belongs to a gripper by its name (finger, gripper, jaw, knuckle), because it slides by
/// less than 0.15 m, or because it follows such a joint.
std::optional<Gripper> find_gripper(const model::Urdf& urdf);

}  // namespace hg::new_files

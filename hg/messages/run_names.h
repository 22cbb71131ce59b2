/// Names that the messages of a run carry, fixed during the run.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hg/core/types.h"
#include "hg/signals/limit.h"
#include "hg/signals/state.h"

namespace hg::messages {

/// Joint of the twin, in the order of its coordinates.
struct TwinJoint {
  std::string name;
  /// Has 7 coordinates and 6 velocities, and is not part of a JointState
  bool is_floating = false;
};

struct RunNames {
  std::vector<std::string> gantry_joints, manipulator_joints;
  std::vector<TwinJoint> twin_joints;
  LimitCatalogue limits;
};

/// A frame of the tree of /tf.
struct LinkFrame {
  std::string parent, child;
};

/// Links of device and twin, drawn by tools as a robot model.
struct LinkTree {
  std::vector<LinkFrame> frames;
  /// Fills the pose of each frame in its parent; not called where `frames` is empty.
  std::function<void(const Sample&, std::vector<Pose>&)> poses;
};

}  // namespace hg::messages

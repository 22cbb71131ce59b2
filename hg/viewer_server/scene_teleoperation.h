/// Remote machine of a teleoperation, as a page draws it. Constant during a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"

namespace hg::viewer_server {

/// What a remote machine is led by: its tool along three axes, or its joints, which are the twin's.
enum class RemoteMapping : std::uint8_t { kTool, kJoints };

/// One coordinate of a remote machine.
struct SceneAxis {
  std::string name;  ///< x, y, z, or a joint of the twin
  Interval range;    ///< m or rad
};

/// A wall before a remote machine, in its coordinates.
struct SceneWall {
  std::vector<double> normal;  ///< unit vector out of the wall
  double offset = 0.0;         ///< position of its surface along the normal, m or rad
};

/// The remote machine of a teleoperation.
struct SceneTeleoperation {
  RemoteMapping mapping = RemoteMapping::kTool;
  std::string method;  ///< name of the method of bilateral control
  std::string link;    ///< what is simulated of the link, in words; empty = nothing
  double force_scale = 1.0;
  Pose T_B_root;  ///< where its base is drawn
  std::vector<SceneAxis> axes;
  std::vector<SceneWall> walls;
};

}  // namespace hg::viewer_server

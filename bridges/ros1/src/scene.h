/// What the program says once about a run, as far as ROS needs it: GET /scene.json.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hapticgiant {

/// A virtual surface; lengths in m, in the frame `base`.
struct Surface {
  std::string name, shape;  ///< plane, box, sphere, cylinder or mesh
  geometry_msgs::Pose pose;
  geometry_msgs::Vector3 size;
  std::vector<geometry_msgs::Point> triangles;  ///< three corners each, of a mesh
};

/// A value of the twin that may be changed while it runs.
struct Setting {
  std::string name, unit, help;
  double min = 0.0, max = 0.0, value = 0.0;
};

struct Scene {
  geometry_msgs::Point box_min, box_max;  ///< limits of the handle, m in `base`
  double floor_z = 0.0;                   ///< m in `base`
  std::vector<Surface> surfaces;
  std::vector<Setting> settings;
};

/// Throws nlohmann::json::exception when the text is not a scene.
Scene parse_scene(const std::string& text);

}  // namespace hapticgiant

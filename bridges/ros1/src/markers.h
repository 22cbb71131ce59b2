/// What rviz has no display for, as markers: the user's wrench, torques of the joints, the
/// scanner's zone, limits of the handle and virtual surfaces. Colours and sizes are those of the
/// program's page.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/JointState.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <string>

#include "scene.h"

namespace hapticgiant {

class Markers {
 public:
  void set_scene(const Scene& scene);

  /// Takes axes and largest torques of the joints from the device's URDF. A text that is none gives
  /// a device without joints.
  void set_device(const std::string& urdf);

  /// Whether the field of the scanner is clear; unknown until the first call.
  void set_field_clear(bool is_clear) { is_field_clear_ = is_clear; }

  /// What stands still: zone, box and surfaces, in the frame `base`. The first time after
  /// set_scene() what was there before is deleted.
  visualization_msgs::MarkerArray fixed();

  /// Wrench and torques, in the frames of handle and links. Values that are not numbers are not
  /// shown.
  visualization_msgs::MarkerArray moving(const sensor_msgs::JointState& joints,
                                         const geometry_msgs::WrenchStamped& wrench) const;

 private:
  struct Joint {
    std::string link;             ///< the link that it moves
    geometry_msgs::Vector3 axis;  ///< in that link
    double torque_max;            ///< Nm
  };

  Scene scene_;
  bool has_scene_ = false, is_new_ = false, is_field_clear_ = true;
  std::map<std::string, Joint> joints_;
};

}  // namespace hapticgiant

/// Scene drawn by a page: two chains, their limits and the box of the handle. Constant during a
/// run.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/core/types.h"
#include "hg/signals/limit.h"
#include "hg/viewer_server/commands.h"
#include "hg/viewer_server/scene_teleoperation.h"

namespace hg::viewer_server {

/// Joint type. Revolute and prismatic joints have one coordinate, a floating joint seven (x y z qx
/// qy qz qw).
enum class JointType : std::uint8_t { kRevolute, kPrismatic, kFloating };

struct SceneJoint {
  std::string name;  ///< name in the URDF; a floating joint not in it moves the root link
  JointType type = JointType::kRevolute;
  /// Planar joint of the URDF to which this one belongs: two prismatic joints and a revolute one in
  /// sequence; empty for other joints.
  std::string planar;
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitX();  ///< axis of such a part, in the frame of the planar joint
  Interval range;                ///< rad or m
  double dq_max = kInfinity;     ///< rad/s or m/s
  double tau_max = kInfinity;    ///< peak, Nm or N; infinite: unknown
};

/// A joint that follows another one by a curve: its position over that of the other.
struct SceneFollower {
  std::string joint, leader;   ///< names in the URDF
  Interval range;              ///< of the leader, rad or m
  bool is_periodic = false;    ///< the range is one turn, and repeats
  std::vector<double> values;  ///< at equal distances over the range, rad or m
};

struct SceneChain {
  std::string name;                      ///< name for people
  std::filesystem::path urdf;            ///< empty: the page draws a plain body at the handle
  std::string address;                   ///< address of the URDF on the server, filled by it
  std::string urdf_text;                 ///< text of a recorded URDF; empty: the file is read
  std::string live_text;                 ///< text of the URDF for live clients; empty: the same
  Pose T_B_root;                         ///< root link in B
  std::vector<SceneJoint> joints;        ///< in the order of the coordinates
  std::vector<SceneFollower> followers;  ///< joints on curves, which have no coordinates
};

/// Surroundings of the twin.
enum class Environment : std::uint8_t { kRoom, kDoor, kExcavator };

enum class SurfaceShape : std::uint8_t { kPlane, kBox, kSphere, kCylinder, kMesh };

/// A virtual surface.
struct SceneSurface {
  std::string name;
  SurfaceShape shape = SurfaceShape::kPlane;
  Pose pose;  ///< pose in B
  /// Size of the bounding box, m; zero for a plane
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  std::vector<double> triangles;  ///< mesh only: 9 coordinates each, m
};

/// A shape of the device by which collisions with itself are foreseen: a capsule along its z axis,
/// or a box.
struct SceneShape {
  std::string name;
  std::string link;                                ///< link of the device's URDF that it moves with
  Pose pose;                                       ///< pose in the link
  double radius = 0.0, length = 0.0;               ///< of a capsule, length without its ends, m
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< of a box, m; zero for a capsule
};

/// A place that an expected event asks the handle to be brought to.
struct SceneCheckpoint {
  std::string name;          ///< of the event
  double x = 0.0, y = 0.0;   ///< of the handle in B, m
  double azimuth_rad = 0.0;  ///< of the hand axis about z of B
};

enum class Source : std::uint8_t { kRun, kRecording };

struct Choice {
  std::string name, title;
  std::string group;  ///< heading that it stands below; empty: none
};

/// Options offered to a page, and the names of the chosen ones.
struct Choices {
  std::string scenario, twin, device, surfaces, law, person;
  std::vector<Choice> scenarios, twins, devices, surface_sets, laws, people;
};

/// Value of the twin that a page may change: a field of its form.
struct Setting {
  std::string name;   ///< for example "hinge.damping_Nms_per_rad"
  std::string group;  ///< joint of the twin, or empty
  std::string label, unit;
  double min = 0.0, max = 0.0;  ///< accepted range
  double value = 0.0;           ///< initial value; may be infinite
  double step = 0.0;
  std::string help;
};

struct Scene {
  std::uint64_t run = 1;  ///< number of the run, counts up
  Source source = Source::kRun;
  std::string title, description;
  double begin_s = 0.0;     ///< begin of a recording, in the time of its run, s
  double duration_s = 0.0;  ///< duration of a recording, or planned, s; 0 = open
  SceneChain device;        ///< gantry joints first, then manipulator: coordinates q_p, then q_m
  SceneChain twin;          ///< coordinates q_a
  bool twin_base_moves = false;  ///< the root link of the twin moves
  LimitCatalogue limits;
  Eigen::AlignedBox3d box;  ///< Cartesian limits of the handle in B; dragging ends 0.5 m outside
  double floor_z = 0.0;     ///< height of the floor in B, m
  double rate_hz = 1000.0;  ///< rate of the control cycle, Hz
  double update_rate_hz = 0.0;  ///< rate of frames, Hz; filled by the server
  int gantry_joints = 0;        ///< number of gantry joints, the first ones of the device
  Environment environment = Environment::kRoom;
  std::vector<SceneSurface> surfaces;
  std::vector<SceneShape> shapes;
  std::vector<SceneCheckpoint> checkpoints;  ///< in the order of their events
  std::optional<SceneTeleoperation> teleoperation;
  Choices choices;
  std::vector<Setting> settings;
  std::vector<CommandName> commands;  ///< accepted commands
  std::string refusal;                ///< why other commands are refused; empty: all are accepted
  /// Stiffness of the arm that pulls the hand to its target, along x, y, z of B, N/m
  Eigen::Vector3d hand_stiffness{250, 150, 200};
  double hand_force_max = 60.0;  ///< its largest pull, N
  std::string stopping;          ///< duration and distance of a stop; empty: unknown
};

/// Throws SetupError unless the files exist, names are given and the box and rate are finite.
void check_scene(const Scene& scene);

}  // namespace hg::viewer_server

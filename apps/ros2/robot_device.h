/// A robot of ROS 2 as a device: it is commanded by topics, and served to a controller over the
/// device protocol (docs/reference/device_protocol.md).
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "apps/ros2/node.h"

namespace hg::ros2 {

struct RobotOptions {
  NodeOptions node;
  std::string name = "example arm";  ///< of the device, as in its device.yaml
  std::vector<std::string> joints;   ///< names in joint states, in the order of the device
  double rate_Hz = 250.0;
  std::string listen = "127.0.0.1:4810";
  std::string key_file;
  bool has_torques = false;              ///< commands are efforts, otherwise velocities
  std::string states = "/joint_states";  ///< sensor_msgs/msg/JointState
  std::string wrench;                    ///< geometry_msgs/msg/WrenchStamped; empty: no sensor
  std::string commands = "/forward_velocity_controller/commands";  ///< Float64MultiArray
  std::string dead_man;                                            ///< std_msgs/msg/Bool
  bool has_no_dead_man = false;  ///< there is no such switch: the hand always holds
  double gain = 10.0;            ///< 1/s, of the position error, for velocities
  double silence_s = 0.05;       ///< state or wrench older than this: fault, commands 0
  bool is_simulated = false;
};

/// Serves until `stop`. However a session ends, zeros are commanded. Throws SetupError.
void run_robot(const RobotOptions& options, const std::atomic<bool>& stop);

}  // namespace hg::ros2

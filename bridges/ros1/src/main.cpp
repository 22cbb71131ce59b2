/// The node `hapticgiant_bridge`: a running program as topics, services and parameters of ROS 1.

#include <ros/ros.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "bridge.h"

namespace {

constexpr int kBadInput = 2;
constexpr const char* kUsage =
    "Shows a running program to ROS 1: topics, services and settings (docs/start/ros1.md).\n\n"
    "Usage: hapticgiant bridge ros1 [LINK] [NAME:=VALUE...]\n\n"
    "  LINK              what `hapticgiant run` prints; default: the newest run on this computer\n"
    "  _mesh_folder:=F   where meshes are put for rviz; default: ~/.ros/hapticgiant\n"
    "  __ns:=NAMESPACE   namespace of all topics; other remappings as for each node\n"
    "  --help            this text\n\n"
    "It waits for a master (roscore) and for a program, and finds both again.\n";

std::filesystem::path default_mesh_folder() {
  const char* ros_home = std::getenv("ROS_HOME");
  const char* home = std::getenv("HOME");
  if (ros_home != nullptr) return std::filesystem::path(ros_home) / "hapticgiant";
  return std::filesystem::path(home != nullptr ? home : "/tmp") / ".ros/hapticgiant";
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc + 1);  // ros::init() takes its own out of argv
  if (argc > 1 && std::string(argv[1]) == "--help") {
    std::cout << kUsage;
    return EXIT_SUCCESS;
  }
  ros::init(argc, argv, "hapticgiant_bridge");
  if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
    std::cerr << "hapticgiant_bridge: expected one link, got '" << argv[argc - 1] << "'\n\n"
              << kUsage;
    return kBadInput;
  }
  const ros::NodeHandle options("~");
  const auto link = options.param<std::string>("link", argc > 1 ? argv[1] : "");
  const auto folder = options.param("mesh_folder", default_mesh_folder().string());
  try {
    hapticgiant::FindLink find_link = hapticgiant::newest_link;
    if (!link.empty()) find_link = [only = hapticgiant::parse_link(link)] { return only; };
    if (!hapticgiant::Bridge(find_link, folder).run()) return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::cerr << "hapticgiant_bridge: " << error.what() << "\n";
    return kBadInput;
  }
  ROS_WARN("there is a new master: beginning again");
  ros::shutdown();
  execv("/proc/self/exe", arguments.data());
  return EXIT_FAILURE;
}

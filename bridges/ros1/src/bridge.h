/// The node: what a running program says becomes topics, what others say goes to the program.
///
/// Topics and services have the names of the live interface, relative to the node's namespace. The
/// thread that calls run() has the connection; ROS calls on threads of its own.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "live_client.h"
#include "markers.h"
#include "settings.h"

namespace hapticgiant {

class Bridge {
 public:
  /// `mesh_folder`: where the meshes of URDFs are put for rviz.
  Bridge(FindLink find_link, std::filesystem::path mesh_folder);

  /// Until ROS ends, or the master is another one than before: true then, and the node must begin
  /// again to be known to it.
  bool run();

 private:
  template <typename Message>
  void pass_on(const std::string& topic, std::function<void(const Message&)> also = {});
  template <typename Message>
  void take(const std::string& topic, const std::string& type);
  void serve(const std::string& service);
  void describe(const std::string& topic);
  void pass_on_events();
  LiveEvents live_events();

  void opened();
  void closed(const std::string& reason);
  void update_scene();
  void note_diagnostics(const diagnostic_msgs::DiagnosticArray& diagnostics);
  bool trigger(const std::string& service, std_srvs::Trigger::Response& response);
  void tick();
  void tick_second();
  void watch_master();

  const std::filesystem::path mesh_folder_;
  ros::NodeHandle node_;
  boost::asio::io_context context_{1};
  boost::asio::steady_timer timer_;
  std::map<std::string, ros::Publisher> publishers_;
  std::map<std::string, std::function<void(Bytes)>> handlers_;  ///< by topic
  std::vector<Publication> publications_;
  std::vector<ros::Subscriber> subscribers_;
  ros::CallbackQueue stops_;  ///< of the service that waits for no other
  std::vector<ros::ServiceServer> services_;
  ros::Publisher clock_, markers_topic_;
  Settings settings_;
  Markers markers_;
  sensor_msgs::JointState joints_;
  geometry_msgs::WrenchStamped wrench_;
  bool is_open_ = false;
  std::atomic<bool> has_new_master_{false};
  std::string last_reason_;
  std::uint64_t ticks_ = 0;
  std::optional<LiveClient> client_;  ///< last: it uses what stands above
};

}  // namespace hapticgiant

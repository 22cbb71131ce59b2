/// Values of the twin that may be changed while it runs, by ROS 1's own way: dynamic_reconfigure.
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "scene.h"

namespace hapticgiant {

/// Server that rqt_reconfigure and dynparam talk to, in the node's private namespace.
class Settings {
 public:
  using Set = std::function<void(const std::string& name, const nlohmann::json& value)>;

  /// `set` is called on the thread of ROS and hands a value on to the program.
  explicit Settings(Set set);

  /// New settings with their ranges.
  void set_scene(const Scene& scene);

  /// Values reported by the program: [{name, value}, ...]; `is_answer`: because of `set`.
  void update(const nlohmann::json& parameters, bool is_answer);

 private:
  bool reconfigure(dynamic_reconfigure::Reconfigure::Request& request,
                   dynamic_reconfigure::Reconfigure::Response& response);
  dynamic_reconfigure::Config config() const;  // with the mutex held
  void describe();                             // with the mutex held

  const Set set_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer service_;
  std::mutex mutex_;
  std::condition_variable answered_;
  std::uint64_t answers_ = 0;
  std::map<std::string, Setting> settings_;
};

}  // namespace hapticgiant

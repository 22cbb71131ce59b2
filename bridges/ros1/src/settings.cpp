#include "settings.h"

#include <dynamic_reconfigure/ConfigDescription.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace hapticgiant {
namespace {

constexpr auto kPatience = std::chrono::seconds(2);
constexpr const char* kUnlimited = "unlimited";  // what the live interface calls infinity
constexpr double kLargest = std::numeric_limits<double>::max();

void add(dynamic_reconfigure::Config& config, const std::string& name, double value) {
  dynamic_reconfigure::DoubleParameter parameter;
  parameter.name = name;
  parameter.value = value;
  config.doubles.push_back(parameter);
}

void add_group(dynamic_reconfigure::Config& config) {
  dynamic_reconfigure::GroupState group;
  group.name = "Default";
  group.state = 1;
  config.groups.push_back(group);
}

}  // namespace

Settings::Settings(Set set) : set_(std::move(set)) {
  ros::NodeHandle node("~");
  descriptions_ =
      node.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
  updates_ = node.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true);
  service_ = node.advertiseService("set_parameters", &Settings::reconfigure, this);
}

void Settings::set_scene(const Scene& scene) {
  const std::lock_guard lock(mutex_);
  std::map<std::string, Setting> settings;
  for (const Setting& setting : scene.settings) {
    settings[setting.name] = setting;
    const auto known = settings_.find(setting.name);
    if (known != settings_.end()) settings[setting.name].value = known->second.value;
  }
  settings_ = std::move(settings);
  describe();
}

void Settings::update(const nlohmann::json& parameters, bool is_answer) {
  const std::lock_guard lock(mutex_);
  bool has_new = false;
  for (const nlohmann::json& parameter : parameters) {
    const std::string name = parameter.at("name");
    const auto value = parameter.find("value");
    const bool is_unlimited = value != parameter.end() && *value == kUnlimited;
    if (value == parameter.end() || (!value->is_number() && !is_unlimited)) continue;
    const auto [setting, is_new] =
        settings_.try_emplace(name, Setting{name, "", "", -kLargest, kLargest, 0.0});
    setting->second.value =
        is_unlimited ? std::numeric_limits<double>::infinity() : value->get<double>();
    has_new = has_new || is_new;
  }
  if (has_new) describe();
  updates_.publish(config());
  if (!is_answer) return;
  ++answers_;
  answered_.notify_all();
}

// Answers with what holds afterwards: what the program refuses stays as it was.
bool Settings::reconfigure(dynamic_reconfigure::Reconfigure::Request& request,
                           dynamic_reconfigure::Reconfigure::Response& response) {
  std::unique_lock lock(mutex_);
  for (const auto& wanted : request.config.doubles) {
    const auto setting = settings_.find(wanted.name);
    if (setting == settings_.end()) {
      ROS_ERROR("there is no setting '%s'", wanted.name.c_str());
      return false;
    }
    if (setting->second.value == wanted.value) continue;  // rqt_reconfigure sends all
    const std::uint64_t before = answers_;
    if (std::isfinite(wanted.value)) {
      set_(wanted.name, wanted.value);
    } else {
      set_(wanted.name, kUnlimited);
    }
    if (!answered_.wait_for(lock, kPatience, [&] { return answers_ != before; })) {
      ROS_ERROR("no answer of the program to the setting '%s'", wanted.name.c_str());
      return false;
    }
  }
  response.config = config();
  return true;
}

dynamic_reconfigure::Config Settings::config() const {
  dynamic_reconfigure::Config config;
  for (const auto& [name, setting] : settings_) add(config, name, setting.value);
  add_group(config);
  return config;
}

void Settings::describe() {
  dynamic_reconfigure::ConfigDescription description;
  dynamic_reconfigure::Group group;
  group.name = "Default";
  for (const auto& [name, setting] : settings_) {
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = name;
    parameter.type = "double";
    parameter.description = setting.help + (setting.unit.empty() ? "" : " [" + setting.unit + "]");
    group.parameters.push_back(parameter);
    add(description.min, name, setting.min);
    add(description.max, name, setting.max);
    add(description.dflt, name, setting.value);
  }
  description.groups.push_back(group);
  for (auto* config : {&description.min, &description.max, &description.dflt}) add_group(*config);
  descriptions_.publish(description);
  updates_.publish(config());
}

}  // namespace hapticgiant

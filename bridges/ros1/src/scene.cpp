#include "scene.h"

#include <limits>

namespace hapticgiant {
namespace {

using nlohmann::json;

template <typename Xyz>
Xyz xyz(const json& list) {
  Xyz value;
  value.x = list.at(0);
  value.y = list.at(1);
  value.z = list.at(2);
  return value;
}

Surface parse_surface(const json& entry) {
  Surface surface;
  surface.name = entry.at("name");
  surface.shape = entry.at("shape");
  surface.pose.position = xyz<geometry_msgs::Point>(entry.at("p_B_m"));
  const json& rotation = entry.at("quaternion_B");
  surface.pose.orientation.x = rotation.at(0);
  surface.pose.orientation.y = rotation.at(1);
  surface.pose.orientation.z = rotation.at(2);
  surface.pose.orientation.w = rotation.at(3);
  surface.size = xyz<geometry_msgs::Vector3>(entry.at("size_m"));
  const json& corners = entry.at("triangles_m");
  for (std::size_t i = 0; i + 3 <= corners.size(); i += 3) {
    geometry_msgs::Point corner;
    corner.x = corners[i];
    corner.y = corners[i + 1];
    corner.z = corners[i + 2];
    surface.triangles.push_back(corner);
  }
  return surface;
}

Setting parse_setting(const json& entry) {
  const json& value = entry.at("value");  // null: unlimited
  Setting setting;
  setting.name = entry.at("name");
  setting.unit = entry.at("unit");
  setting.help = entry.at("help");
  setting.min = entry.at("min");
  setting.max = entry.at("max");
  setting.value = value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
  return setting;
}

}  // namespace

Scene parse_scene(const std::string& text) {
  const json message = json::parse(text);
  Scene scene;
  scene.box_min = xyz<geometry_msgs::Point>(message.at("box").at("min_m"));
  scene.box_max = xyz<geometry_msgs::Point>(message.at("box").at("max_m"));
  scene.floor_z = message.at("floor_z_m");
  for (const json& entry : message.at("surfaces")) scene.surfaces.push_back(parse_surface(entry));
  for (const json& entry : message.at("settings")) scene.settings.push_back(parse_setting(entry));
  return scene;
}

}  // namespace hapticgiant

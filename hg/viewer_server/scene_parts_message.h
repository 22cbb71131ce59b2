/// Parts of a Scene. See message.h for the rules.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/signals/limit.h"
#include "hg/viewer_server/message.h"
#include "hg/viewer_server/scene.h"

namespace hg::viewer_server {

enum class LimitUnit : std::uint8_t { kRad, kM };

struct SceneLimitMessage {
  std::string name;
  LimitKind kind = LimitKind::kManipulatorJoint;
  LimitUnit unit = LimitUnit::kRad;
  std::optional<double> min, max;
  int priority = 0;
};

/// The catalogue as the page lists it, with the level of the law of each limit.
std::vector<SceneLimitMessage> limit_messages(const LimitCatalogue& limits);

template <>
inline constexpr Interface kInterface<SceneJoint> = {"SceneJoint", "a joint of a chain"};
template <>
inline constexpr Interface kInterface<SceneFollower> = {
    "SceneFollower", "a joint that follows another one by a curve: its position over the other's"};
template <>
inline constexpr Interface kInterface<SceneChain> = {"SceneChain", "a robot or a twin"};
template <>
inline constexpr Interface kInterface<SceneLimitMessage> = {"SceneLimit", "a limited quantity"};
template <>
inline constexpr Interface kInterface<Eigen::AlignedBox3d> = {
    "SceneBox", "Cartesian limits of the handle in B"};
template <>
inline constexpr Interface kInterface<SceneSurface> = {"SceneSurface", "a virtual surface"};
template <>
inline constexpr Interface kInterface<SceneShape> = {
    "SceneShape", "a shape by which collisions of the device with itself are foreseen"};
template <>
inline constexpr Interface kInterface<SceneCheckpoint> = {
    "SceneCheckpoint",
    "a place of the handle that an event asks for, nearer than 0.10 m, 15 degrees"};
template <>
inline constexpr Interface kInterface<Choice> = {"Choice", "one option"};
template <>
inline constexpr Interface kInterface<Choices> = {"Choices", "options and the chosen ones"};
template <>
inline constexpr Interface kInterface<Setting> = {"Setting", "a form field: a value of the twin"};

template <typename Archive, Is<SceneJoint> T>
void fields(Archive& a, T& joint) {
  a("name", joint.name, "name in the URDF");
  a("type", joint.type, "floating: x y z qx qy qz qw");
  a("planar", joint.planar,
    "planar joint of the URDF with this joint as one of three parts: slide, slide, turn");
  a("axis", joint.axis, "axis of such a part, in the frame of the planar joint", unit::kNone);
  a("q_min", bounded(joint.range.lb), "lower limit; null = unbounded", unit::kJointPosition);
  a("q_max", bounded(joint.range.ub), "upper limit; null = unbounded", unit::kJointPosition);
  a("dq_max", bounded(joint.dq_max), "speed limit; null = unbounded", unit::kJointSpeed);
  a("tau_max", bounded(joint.tau_max), "peak torque or force; null = unknown", unit::kJointTorque);
}

template <typename Archive, Is<SceneFollower> T>
void fields(Archive& a, T& follower) {
  a("joint", follower.joint);
  a("leader", follower.leader);
  a("begin", follower.range.lb, "begin of the range of the leader", unit::kJointPosition);
  a("end", follower.range.ub, "end of the range of the leader", unit::kJointPosition);
  a("is_periodic", follower.is_periodic, "the range is one turn, and repeats");
  a("values", follower.values, "positions at equal distances over the range", unit::kJointPosition);
}

template <typename Archive, Is<SceneChain> T>
void fields(Archive& a, T& chain) {
  a("name", chain.name, "name for people");
  a("urdf", chain.urdf.empty() ? "" : chain.address, "address of the file, empty = none");
  a("p_B_root_m", chain.T_B_root.p);
  a("quaternion_B_root", quaternion(chain.T_B_root.R));
  a("joints", chain.joints, "joints in the order of the coordinates");
  a("followers", chain.followers, "joints that follow by curves, which have no coordinates");
}

template <typename Archive, Is<SceneLimitMessage> T>
void fields(Archive& a, T& limit) {
  a("name", limit.name);
  a("kind", limit.kind);
  a("unit", limit.unit, "unit of the position; the reaction has that of a torque or of a force");
  a("min", limit.min, "lower end; null = unbounded", unit::kJointPosition);
  a("max", limit.max, "upper end; null = unbounded", unit::kJointPosition);
  a("priority", limit.priority,
    "level of the law: 1 is the coupling of hand and twin, then 2, 3, ...");
}

template <typename Archive, Is<Eigen::AlignedBox3d> T>
void fields(Archive& a, T& box) {
  a("min_m", Eigen::Vector3d(box.min()));
  a("max_m", Eigen::Vector3d(box.max()));
}

template <typename Archive, Is<SceneSurface> T>
void fields(Archive& a, T& surface) {
  a("name", surface.name);
  a("shape", surface.shape, "a plane is solid below its z = 0, a cylinder has its axis along z");
  a("p_B_m", surface.pose.p, "position of the centre");
  a("quaternion_B", quaternion(surface.pose.R));
  a("size_m", surface.size, "size of the bounding box; zero for a plane");
  a("triangles_m", surface.triangles, "triangles of a mesh, 9 coordinates each; else empty");
}

template <typename Archive, Is<SceneShape> T>
void fields(Archive& a, T& shape) {
  a("name", shape.name);
  a("link", shape.link, "link of the device's URDF that it moves with");
  a("p_link_m", shape.pose.p, "position of the centre");
  a("quaternion_link", quaternion(shape.pose.R));
  a("radius_m", shape.radius, "radius of a capsule along z");
  a("length_m", shape.length, "length of a capsule, without its ends");
  a("size_m", shape.size, "size of a box; zero for a capsule");
}

template <typename Archive, Is<SceneCheckpoint> T>
void fields(Archive& a, T& checkpoint) {
  a("name", checkpoint.name, "name of the event");
  a("x_m", checkpoint.x, "position in B");
  a("y_m", checkpoint.y, "position in B");
  a("azimuth_rad", checkpoint.azimuth_rad, "azimuth of the hand axis, z of H, about z of B");
}

template <typename Archive, Is<Choice> T>
void fields(Archive& a, T& choice) {
  a("name", choice.name, "name in a command");
  a("title", choice.title, "name for people");
  a("group", choice.group, "heading that it stands below; empty: none");
}

template <typename Archive, Is<Choices> T>
void fields(Archive& a, T& choices) {
  a("scenario", choices.scenario, "name of the chosen scenario");
  a("scenarios", choices.scenarios);
  a("twin", choices.twin, "name of the chosen twin; empty: that of the scenario");
  a("twins", choices.twins);
  a("device", choices.device, "name of the chosen device; empty: that of the scenario");
  a("devices", choices.devices);
  a("surfaces", choices.surfaces,
    "scenario whose virtual surfaces are met, none; empty: those of the scenario");
  a("surface_sets", choices.surface_sets);
  a("law", choices.law);
  a("laws", choices.laws);
  a("person", choices.person,
    "person at the handle: a script, mouse, none; empty: that of the scenario");
  a("people", choices.people);
}

template <typename Archive, Is<Setting> T>
void fields(Archive& a, T& setting) {
  a("name", setting.name, "name in the command \"set\"");
  a("group", setting.group, "joint of the twin, or empty");
  a("label", setting.label);
  a("unit", setting.unit, "unit of all numbers of the setting");
  a("min", setting.min, "smallest accepted value", unit::kNone);
  a("max", setting.max, "largest accepted value", unit::kNone);
  a("value", bounded(setting.value), "initial value, later ones come as Values; null = unlimited",
    unit::kNone);
  a("step", setting.step, "step of the form", unit::kNone);
  a("help", setting.help);
}

}  // namespace hg::viewer_server

/// Standard ROS 2 messages that other tools understand, as far as a recording uses them. Field
/// names and order are those of ROS; see message.h for the rules.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hg/recording/message.h"

namespace hg::recording {

struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

struct Header {
  Time stamp;
  std::string frame_id;
};

struct JointState {
  Header header;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;  ///< rad or m; NaN = not measured
};

struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
};

struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};

struct Wrench {
  Vector3 force, torque;
};

struct WrenchStamped {
  Header header;
  Wrench wrench;
};

struct Transform {
  Vector3 translation;
  Quaternion rotation;
};

struct TransformStamped {
  Header header;
  std::string child_frame_id;
  Transform transform;
};

struct TransformMessage {
  std::vector<TransformStamped> transforms;
};

template <>
inline constexpr std::string_view kStandardName<Time> = "builtin_interfaces/Time";
template <>
inline constexpr std::string_view kStandardName<Header> = "std_msgs/Header";
template <>
inline constexpr std::string_view kStandardName<JointState> = "sensor_msgs/JointState";
template <>
inline constexpr std::string_view kStandardName<Vector3> = "geometry_msgs/Vector3";
template <>
inline constexpr std::string_view kStandardName<Quaternion> = "geometry_msgs/Quaternion";
template <>
inline constexpr std::string_view kStandardName<Wrench> = "geometry_msgs/Wrench";
template <>
inline constexpr std::string_view kStandardName<WrenchStamped> = "geometry_msgs/WrenchStamped";
template <>
inline constexpr std::string_view kStandardName<Transform> = "geometry_msgs/Transform";
template <>
inline constexpr std::string_view kStandardName<TransformStamped> =
    "geometry_msgs/TransformStamped";
template <>
inline constexpr std::string_view kStandardName<TransformMessage> = "tf2_msgs/TFMessage";

template <typename Archive, Is<Time> T>
void fields(Archive& a, T& time) {
  a("sec", time.sec);
  a("nanosec", time.nanosec);
}

template <typename Archive, Is<Header> T>
void fields(Archive& a, T& header) {
  a("stamp", header.stamp);
  a("frame_id", header.frame_id);
}

template <typename Archive, Is<JointState> T>
void fields(Archive& a, T& state) {
  a("header", state.header);
  a("name", state.name);
  a("position", state.position);
  a("velocity", state.velocity);
  a("effort", state.effort);
}

template <typename Archive, Is<Vector3> T>
void fields(Archive& a, T& vector) {
  a("x", vector.x);
  a("y", vector.y);
  a("z", vector.z);
}

template <typename Archive, Is<Quaternion> T>
void fields(Archive& a, T& quaternion) {
  a("x", quaternion.x);
  a("y", quaternion.y);
  a("z", quaternion.z);
  a("w", quaternion.w);
}

template <typename Archive, Is<Wrench> T>
void fields(Archive& a, T& wrench) {
  a("force", wrench.force);
  a("torque", wrench.torque);
}

template <typename Archive, Is<WrenchStamped> T>
void fields(Archive& a, T& stamped) {
  a("header", stamped.header);
  a("wrench", stamped.wrench);
}

template <typename Archive, Is<Transform> T>
void fields(Archive& a, T& transform) {
  a("translation", transform.translation);
  a("rotation", transform.rotation);
}

template <typename Archive, Is<TransformStamped> T>
void fields(Archive& a, T& stamped) {
  a("header", stamped.header);
  a("child_frame_id", stamped.child_frame_id);
  a("transform", stamped.transform);
}

template <typename Archive, Is<TransformMessage> T>
void fields(Archive& a, T& message) {
  a("transforms", message.transforms);
}

}  // namespace hg::recording

/// Standard ROS 2 messages that other tools understand, as far as recordings and the live interface
/// use them. Field names and order are those of ROS; see message.h for the rules.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hg/messages/message.h"

namespace hg::messages {

struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

/// A time since 1970, ns, in the form of ROS.
inline Time to_ros(std::uint64_t time_ns) {
  constexpr std::uint64_t kPerSecond = 1'000'000'000;
  return {static_cast<std::int32_t>(time_ns / kPerSecond),
          static_cast<std::uint32_t>(time_ns % kPerSecond)};
}

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

struct Twist {
  Vector3 linear, angular;  ///< m/s, rad/s
};

struct TwistStamped {
  Header header;
  Twist twist;
};

struct Point {
  double x = 0.0, y = 0.0, z = 0.0;
};

/// geometry_msgs/Pose; not hg::Pose.
struct PointPose {
  Point position;
  Quaternion orientation;
};

struct PoseStamped {
  Header header;
  PointPose pose;
};

/// std_msgs/String.
struct TextMessage {
  std::string data;
};

struct KeyValue {
  std::string key, value;
};

struct DiagnosticStatus {
  std::uint8_t level = 0;  ///< 0 OK, 1 warning, 2 error
  std::string name, message, hardware_id;
  std::vector<KeyValue> values;
};

struct DiagnosticArray {
  Header header;
  std::vector<DiagnosticStatus> status;
};

/// Response of std_srvs/srv/Trigger.
struct TriggerResponse {
  bool success = false;
  std::string message;
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
template <>
inline constexpr std::string_view kStandardName<Twist> = "geometry_msgs/Twist";
template <>
inline constexpr std::string_view kStandardName<TwistStamped> = "geometry_msgs/TwistStamped";
template <>
inline constexpr std::string_view kStandardName<Point> = "geometry_msgs/Point";
template <>
inline constexpr std::string_view kStandardName<PointPose> = "geometry_msgs/Pose";
template <>
inline constexpr std::string_view kStandardName<PoseStamped> = "geometry_msgs/PoseStamped";
template <>
inline constexpr std::string_view kStandardName<TextMessage> = "std_msgs/String";
template <>
inline constexpr std::string_view kStandardName<KeyValue> = "diagnostic_msgs/KeyValue";
template <>
inline constexpr std::string_view kStandardName<DiagnosticStatus> =
    "diagnostic_msgs/DiagnosticStatus";
template <>
inline constexpr std::string_view kStandardName<DiagnosticArray> =
    "diagnostic_msgs/DiagnosticArray";
template <>
inline constexpr std::string_view kStandardName<TriggerResponse> = "std_srvs/Trigger_Response";

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

template <typename Archive, Is<Twist> T>
void fields(Archive& a, T& twist) {
  a("linear", twist.linear);
  a("angular", twist.angular);
}

template <typename Archive, Is<TwistStamped> T>
void fields(Archive& a, T& stamped) {
  a("header", stamped.header);
  a("twist", stamped.twist);
}

template <typename Archive, Is<Point> T>
void fields(Archive& a, T& point) {
  a("x", point.x);
  a("y", point.y);
  a("z", point.z);
}

template <typename Archive, Is<PointPose> T>
void fields(Archive& a, T& pose) {
  a("position", pose.position);
  a("orientation", pose.orientation);
}

template <typename Archive, Is<PoseStamped> T>
void fields(Archive& a, T& stamped) {
  a("header", stamped.header);
  a("pose", stamped.pose);
}

template <typename Archive, Is<TextMessage> T>
void fields(Archive& a, T& text) {
  a("data", text.data);
}

template <typename Archive, Is<KeyValue> T>
void fields(Archive& a, T& pair) {
  a("key", pair.key);
  a("value", pair.value);
}

template <typename Archive, Is<DiagnosticStatus> T>
void fields(Archive& a, T& status) {
  a("level", status.level);
  a("name", status.name);
  a("message", status.message);
  a("hardware_id", status.hardware_id);
  a("values", status.values);
}

template <typename Archive, Is<DiagnosticArray> T>
void fields(Archive& a, T& array) {
  a("header", array.header);
  a("status", array.status);
}

template <typename Archive, Is<TriggerResponse> T>
void fields(Archive& a, T& response) {
  a("success", response.success);
  a("message", response.message);
}

}  // namespace hg::messages

#include "markers.h"

#include <urdf/model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace hapticgiant {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::uint32_t kForce = 0xf0643c, kTorque = 0xa855d8, kFieldClear = 0x2fa36b,
                        kFieldTaken = 0xd83a3a, kSurface = 0x6f8fb8, kBox = 0x7f95ab;
constexpr double kMetresPerNewton = 0.01, kSmallestForce = 0.5;  // N; below it no arrow
constexpr double kLongestForce = 0.8;                            // m
constexpr double kRadiansPerNewtonMetre = 0.8, kSmallestTorque = 0.15;
constexpr double kMostTurn = 1.7 * M_PI, kArcRadius = 0.13;  // rad, m
constexpr double kTorqueArc = 1.5 * M_PI;                    // rad, at the largest torque
constexpr double kStrongestJoint = 176.0;                    // Nm; its arc is the largest
constexpr double kLineWidth = 0.016;                         // m
// The zone: 270 degrees to 5 m at the foot of a column, cut off at the hall. [K] SICK TiM781S.
constexpr double kReach = 5.0, kOpening = 1.5 * M_PI, kHeight = 0.2, kBeyond = 0.6;

using Vector = std::array<double, 3>;

Vector vector(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }
double norm(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }
Vector scaled(const Vector& v, double factor) {
  return {v[0] * factor, v[1] * factor, v[2] * factor};
}
Vector sum(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

geometry_msgs::Point point(const Vector& v) {
  geometry_msgs::Point p;
  p.x = v[0];
  p.y = v[1];
  p.z = v[2];
  return p;
}

geometry_msgs::Point point(double x, double y, double z) { return point(Vector{x, y, z}); }

Marker marker(const char* group, int id, int type, const std::string& frame, std::uint32_t color,
              double opacity = 1.0) {
  Marker m;
  m.header.frame_id = frame;  // no stamp: where the frame is now
  m.ns = group;
  m.id = id;
  m.type = type;
  m.action = Marker::ADD;
  m.pose.orientation.w = 1.0;
  m.scale.x = m.scale.y = m.scale.z = 1.0;
  m.color.r = static_cast<float>(color >> 16 & 255) / 255.0F;
  m.color.g = static_cast<float>(color >> 8 & 255) / 255.0F;
  m.color.b = static_cast<float>(color & 255) / 255.0F;
  m.color.a = static_cast<float>(opacity);
  return m;
}

// A marker of a thing that moves: it is gone soon after the last message.
Marker moving_marker(const char* group, int id, int type, const std::string& frame,
                     std::uint32_t color) {
  Marker m = marker(group, id, type, frame, color);
  m.lifetime = ros::Duration(0.5);
  m.frame_locked = true;
  return m;
}

Marker text(const char* group, int id, const std::string& frame, std::uint32_t color,
            const Vector& place, double value, const char* unit) {
  Marker m = moving_marker(group, id, Marker::TEXT_VIEW_FACING, frame, color);
  char words[32];
  std::snprintf(words, sizeof words, "%.*f %s", std::abs(value) < 10.0 ? 1 : 0, value, unit);
  m.text = words;
  m.pose.position = point(place);
  m.scale.z = 0.09;
  return m;
}

Marker arrow(const char* group, int id, const std::string& frame, std::uint32_t color,
             const Vector& from, const Vector& to, double thickness) {
  Marker m = moving_marker(group, id, Marker::ARROW, frame, color);
  m.points = {point(from), point(to)};
  m.scale.x = thickness;        // of the shaft, m
  m.scale.y = 2.8 * thickness;  // of the head
  m.scale.z = std::min(0.09, 0.6 * norm(sum(to, scaled(from, -1.0))));
  return m;
}

// An arc around `axis` with a head at its end, from where `towards` points.
void add_arc(MarkerArray& out, const char* group, int id, const std::string& frame,
             const Vector& axis, double radius, double angle) {
  const Vector z = scaled(axis, 1.0 / norm(axis));
  const Vector other = std::abs(z[0]) < 0.9 ? Vector{1, 0, 0} : Vector{0, 1, 0};
  Vector x = cross(cross(z, other), z);
  x = scaled(x, 1.0 / norm(x));
  const Vector y = cross(z, x);
  const auto at = [&](double turn) {
    return sum(scaled(x, radius * std::cos(turn)), scaled(y, radius * std::sin(turn)));
  };
  Marker arc = moving_marker(group, id, Marker::LINE_STRIP, frame, kTorque);
  arc.scale.x = kLineWidth;
  const int steps = 2 + static_cast<int>(std::abs(angle) * 12.0);
  for (int i = 0; i <= steps; ++i) arc.points.push_back(point(at(angle * i / steps)));
  out.markers.push_back(arc);
  const double head = std::copysign(std::min(0.45, 0.5 * std::abs(angle) + 0.05), angle);
  Marker tip = arrow(group, id + 1, frame, kTorque, at(angle), at(angle + head), 0.014);
  tip.scale.y = 0.045;
  tip.scale.z = radius * std::abs(head);
  out.markers.push_back(tip);
}

double to_edge(double from, double ray, double low, double high) {
  if (std::abs(ray) < 1e-9) return kReach;
  return std::max(0.0, ((ray > 0.0 ? high : low) - from) / ray);
}

// Corners of the scanner's field, the scanner first; it stands at a corner and looks to the middle.
std::vector<geometry_msgs::Point> scanner_field(const Scene& scene) {
  const double low_x = scene.box_min.x - kBeyond, high_x = scene.box_max.x + kBeyond;
  const double low_y = scene.box_min.y - kBeyond, high_y = scene.box_max.y + kBeyond;
  const double z = scene.floor_z + kHeight;
  const double towards = std::atan2(0.5 * (low_y - high_y), 0.5 * (low_x - high_x));
  constexpr int kSteps = 96;
  std::vector<geometry_msgs::Point> corners = {point(high_x, high_y, z)};
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = towards + kOpening * (static_cast<double>(i) / kSteps - 0.5);
    const double x = std::cos(angle), y = std::sin(angle);
    const double reach =
        std::min({kReach, to_edge(high_x, x, low_x, high_x), to_edge(high_y, y, low_y, high_y)});
    corners.push_back(point(high_x + reach * x, high_y + reach * y, z));
  }
  return corners;
}

void add_zone(MarkerArray& out, const Scene& scene, bool is_clear) {
  const std::uint32_t color = is_clear ? kFieldClear : kFieldTaken;
  const auto corners = scanner_field(scene);
  Marker area = marker("scanner", 0, Marker::TRIANGLE_LIST, "base", color, 0.25);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    area.points.insert(area.points.end(), {corners[0], corners[i], corners[i + 1]});
  }
  Marker outline = marker("scanner", 1, Marker::LINE_STRIP, "base", color);
  outline.scale.x = 0.02;
  outline.points = corners;
  outline.points.push_back(corners[0]);
  Marker scanner = marker("scanner", 2, Marker::CYLINDER, "base", color);
  scanner.pose.position = corners[0];
  scanner.scale.x = scanner.scale.y = 0.1;
  scanner.scale.z = 0.12;
  out.markers.insert(out.markers.end(), {area, outline, scanner});
}

Marker box(const Scene& scene) {
  Marker m = marker("box", 0, Marker::LINE_LIST, "base", kBox, 0.7);
  m.scale.x = 0.008;
  const auto& a = scene.box_min;
  const auto& b = scene.box_max;
  const auto corner = [&](int i) {
    return point((i & 1) != 0 ? b.x : a.x, (i & 2) != 0 ? b.y : a.y, (i & 4) != 0 ? b.z : a.z);
  };
  for (int i = 0; i < 8; ++i) {
    for (const int side : {1, 2, 4}) {
      if ((i & side) == 0) m.points.insert(m.points.end(), {corner(i), corner(i | side)});
    }
  }
  return m;
}

Marker surface_marker(const Surface& surface, int id) {
  static const std::map<std::string, int> types = {{"plane", Marker::CUBE},
                                                   {"box", Marker::CUBE},
                                                   {"sphere", Marker::SPHERE},
                                                   {"cylinder", Marker::CYLINDER},
                                                   {"mesh", Marker::TRIANGLE_LIST}};
  const auto type = types.find(surface.shape);
  Marker m = marker("surfaces", id, type == types.end() ? Marker::CUBE : type->second, "base",
                    kSurface, 0.6);
  m.pose = surface.pose;
  m.scale = surface.size;
  if (surface.shape == "plane") {
    m.scale.x = m.scale.y = 2.0;  // it has no end
    m.scale.z = 0.002;
  }
  if (surface.shape == "mesh") {
    m.scale.x = m.scale.y = m.scale.z = 1.0;
    m.points = surface.triangles;
  }
  return m;
}

}  // namespace

void Markers::set_scene(const Scene& scene) {
  scene_ = scene;
  has_scene_ = true;
  is_new_ = true;
}

void Markers::set_device(const std::string& text) {
  joints_.clear();
  urdf::Model model;
  if (!model.initString(text)) return;
  for (const auto& [name, joint] : model.joints_) {
    if (joint->type != urdf::Joint::REVOLUTE && joint->type != urdf::Joint::CONTINUOUS) continue;
    const bool is_rated = joint->limits != nullptr && joint->limits->effort > 0.0;
    Joint& entry = joints_[name];
    entry.link = joint->child_link_name;
    entry.axis.x = joint->axis.x;
    entry.axis.y = joint->axis.y;
    entry.axis.z = joint->axis.z;
    entry.torque_max = is_rated ? joint->limits->effort : kStrongestJoint;
  }
}

MarkerArray Markers::fixed() {
  MarkerArray out;
  if (!has_scene_) return out;
  if (std::exchange(is_new_, false)) {
    out.markers.emplace_back();
    out.markers.back().action = Marker::DELETEALL;
  }
  add_zone(out, scene_, is_field_clear_);
  out.markers.push_back(box(scene_));
  int id = 0;
  for (const Surface& surface : scene_.surfaces)
    out.markers.push_back(surface_marker(surface, id++));
  return out;
}

MarkerArray Markers::moving(const sensor_msgs::JointState& joints,
                            const geometry_msgs::WrenchStamped& wrench) const {
  MarkerArray out;
  const Vector force = vector(wrench.wrench.force), torque = vector(wrench.wrench.torque);
  const std::string& handle = wrench.header.frame_id;
  const double newtons = norm(force), newton_metres = norm(torque);
  if (newtons > kSmallestForce && std::isfinite(newtons)) {
    const double length = std::min(kLongestForce, kMetresPerNewton * newtons);
    const Vector tip = scaled(force, length / newtons);
    out.markers.push_back(arrow("wrench", 0, handle, kForce, {0, 0, 0}, tip, 0.026));
    out.markers.push_back(
        text("wrench", 1, handle, kForce, scaled(force, (length + 0.08) / newtons), newtons, "N"));
  }
  if (newton_metres > kSmallestTorque && std::isfinite(newton_metres)) {
    const double angle = std::min(kMostTurn, kRadiansPerNewtonMetre * newton_metres);
    add_arc(out, "wrench", 2, handle, torque, kArcRadius, angle);
  }
  int id = 0;
  for (std::size_t i = 0; i < std::min(joints.name.size(), joints.effort.size()); ++i, id += 3) {
    const auto found = joints_.find(joints.name[i]);
    const double value = joints.effort[i];
    if (found == joints_.end() || !std::isfinite(value)) continue;
    const Joint& joint = found->second;
    const double share = std::clamp(value / joint.torque_max, -1.0, 1.0);
    const double radius =
        0.09 + 0.075 * std::sqrt(std::min(1.0, joint.torque_max / kStrongestJoint));
    add_arc(out, "torques", id, joint.link, vector(joint.axis), radius, kTorqueArc * share);
    out.markers.push_back(
        text("torques", id + 2, joint.link, kTorque, {0.0, 0.0, 0.0}, value, "Nm"));
    out.markers.back().pose.position.z = radius + 0.06;
  }
  return out;
}

}  // namespace hapticgiant

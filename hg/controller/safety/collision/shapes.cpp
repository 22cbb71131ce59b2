#include "hg/controller/safety/collision/shapes.h"

#include <algorithm>
#include <cmath>
#include <ranges>

#include "hg/model/urdf.h"

namespace hg::collision {
namespace {

using model::Urdf;
using model::UrdfCollision;
using model::UrdfJoint;
using model::UrdfJointType;
using model::UrdfShape;

// Number of joints of the chain between B and this link.
int body_of(const Urdf& urdf, int link, const model::ChainModel& chain) {
  for (std::size_t steps = 0; steps <= urdf.joints.size(); ++steps) {
    const auto above = std::ranges::find(urdf.joints, link, &UrdfJoint::child);
    if (above == urdf.joints.end()) return 0;
    if (above->type == UrdfJointType::kPlanar) return chain.joint(above->name + " turn") + 1;
    if (above->type != UrdfJointType::kFixed) return chain.joint(above->name) + 1;
    link = above->parent;
  }
  return 0;
}

Shape shape_of(const UrdfCollision& element, const std::string& name, int body, int frame) {
  Shape shape = {.name = name, .body = body, .frame = frame, .T_frame_shape = element.T_link_shape};
  switch (element.shape) {
    case UrdfShape::kSphere:
      shape.radius = element.size.x();
      break;
    case UrdfShape::kCylinder:
      shape.radius = element.size.x();
      shape.half_length = 0.5 * element.size.y();
      break;
    case UrdfShape::kBox:
      shape.half_edges = 0.5 * element.size;
      shape.is_box = true;
      break;
    case UrdfShape::kOther:
      break;
  }
  return shape;
}

// Whether a ball around `p` (in the frame of the shapes) lies inside `outer`.
bool holds_ball(const Shape& outer, const Eigen::Vector3d& p, double radius) {
  constexpr double kRounding = 1e-6;
  const Eigen::Vector3d local = outer.T_frame_shape.R.transpose() * (p - outer.T_frame_shape.p);
  if (outer.is_box) {
    return ((local.cwiseAbs() - outer.half_edges).array() + radius).maxCoeff() <= kRounding;
  }
  const double along = std::clamp(local.z(), -outer.half_length, outer.half_length);
  return (local - along * Eigen::Vector3d::UnitZ()).norm() + radius <= outer.radius + kRounding;
}

bool is_inside(const Shape& inner, const Shape& outer) {
  if (inner.is_box || inner.frame != outer.frame) return false;
  const Eigen::Vector3d half = inner.half_length * inner.T_frame_shape.R.col(2);
  return holds_ball(outer, inner.T_frame_shape.p + half, inner.radius) &&
         holds_ball(outer, inner.T_frame_shape.p - half, inner.radius);
}

void drop_inner(std::vector<Shape>& shapes) {
  for (std::size_t i = shapes.size(); i-- > 0;) {
    const auto holds = [&](const Shape& other) {
      return &other != &shapes[i] && is_inside(shapes[i], other);
    };
    if (std::ranges::any_of(shapes, holds)) {
      shapes.erase(shapes.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

}  // namespace

Geometry read_geometry(const Urdf& urdf, const model::ChainModel& chain) {
  Geometry geometry;
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    const model::UrdfLink& link = urdf.links[i];
    const int body = body_of(urdf, static_cast<int>(i), chain);
    const int frame = chain.frame(link.name);
    std::vector<Shape> shapes;
    for (const UrdfCollision& element : link.collisions) {
      if (element.shape == UrdfShape::kOther) continue;
      shapes.push_back(
          shape_of(element, element.name.empty() ? link.name : element.name, body, frame));
    }
    drop_inner(shapes);
    const bool has_unknown =
        std::ranges::count(link.collisions, UrdfShape::kOther, &UrdfCollision::shape) > 0;
    if (body > 0 && (has_unknown || (shapes.empty() && link.inertial))) {
      geometry.links_without.push_back(link.name);
    }
    std::ranges::move(shapes, std::back_inserter(geometry.shapes));
  }
  return geometry;
}

Shape floor_at(double z) {
  constexpr double kHalfWidth = 50.0;
  constexpr double kHalfDepth = 5.0;
  Shape floor = {.name = "floor",
                 .half_edges = {kHalfWidth, kHalfWidth, kHalfDepth},
                 .is_box = true,
                 .is_surrounding = true};
  floor.T_frame_shape.p.z() = z - kHalfDepth;
  return floor;
}

Shape capsule_around(const Shape& box) {
  Eigen::Index longest = 0;
  box.half_edges.maxCoeff(&longest);
  const Eigen::Index y = (longest + 2) % 3;  // so that (x, y, longest) is right-handed
  const Eigen::Index x = (longest + 1) % 3;
  Shape capsule = box;
  capsule.is_box = false;
  capsule.radius = std::hypot(box.half_edges[x], box.half_edges[y]);
  capsule.half_length = box.half_edges[longest];
  capsule.T_frame_shape.R.col(0) = box.T_frame_shape.R.col(x);
  capsule.T_frame_shape.R.col(1) = box.T_frame_shape.R.col(y);
  capsule.T_frame_shape.R.col(2) = box.T_frame_shape.R.col(longest);
  return capsule;
}

double reach(const Shape& shape) noexcept {
  return shape.is_box ? shape.half_edges.norm() : shape.half_length + shape.radius;
}

}  // namespace hg::collision

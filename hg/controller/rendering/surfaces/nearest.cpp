#include "hg/controller/rendering/surfaces/nearest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace hg::surfaces {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kOnIt = 1e-9;       // m; below it the direction to a point is undefined
constexpr double kBeside = 1e-3;     // m; points so near beside a triangle count as over it
constexpr double kBent = 1e-6;       // m
constexpr double kParallel = 0.999;  // cosine between normals

Vector3d nearest_on(const Triangle& triangle, const Vector3d& p) noexcept {
  const auto& corners = triangle.corners;
  const double height = triangle.normal.dot(p - corners[0]);
  const Vector3d foot = p - height * triangle.normal;
  if (is_over(triangle, p, kBeside)) return foot;
  double least = kInfinity;
  Vector3d nearest = foot;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = corners[(i + 1) % 3] - corners[i];
    if (edge.cross(p - corners[i]).dot(triangle.normal) >= 0.0) continue;
    const double share = std::clamp(edge.dot(p - corners[i]) / edge.squaredNorm(), 0.0, 1.0);
    const Vector3d point = corners[i] + share * edge;
    const double distance = (p - point).norm();
    if (distance < least) {
      least = distance;
      nearest = point;
    }
  }
  return nearest;
}

// Sides of a solid near a point: distance of the nearest face towards it, and the nearest way out
// through a face away from it.
struct Side {
  int solid = -1;
  double front = kInfinity;
  Facing out;

  bool is_around() const noexcept { return out.distance < 0.0 && -out.distance < front; }
};

// sides of the first few solids met
class Sides {
 public:
  Side* of(int solid) noexcept {
    for (Side& side : sides_) {
      if (side.solid < 0) side.solid = solid;
      if (side.solid == solid) return &side;
    }
    return nullptr;
  }
  const Side* nearest_around() const noexcept {
    const Side* best = nullptr;
    for (const Side& side : sides_) {
      if (!side.is_around()) continue;
      if (best == nullptr || side.out.distance > best->out.distance) best = &side;
    }
    return best;
  }
  bool has_front() const noexcept { return sides_[0].front < kInfinity; }

 private:
  std::array<Side, 8> sides_;
};

}  // namespace

Facing facing(const Plane&, const Vector3d& p) noexcept { return {Vector3d::UnitZ(), p.z()}; }

Facing facing(const Box& box, const Vector3d& p) noexcept {
  const Vector3d half = 0.5 * box.size;
  const Vector3d away = p - p.cwiseMax(-half).cwiseMin(half);
  const double distance = away.norm();
  if (distance > kOnIt) return {away / distance, distance};
  Eigen::Index axis = 0;
  const double height = (p.cwiseAbs() - half).maxCoeff(&axis);
  return {std::copysign(1.0, p[axis]) * Vector3d::Unit(axis), height};
}

Facing facing(const Sphere& sphere, const Vector3d& p) noexcept {
  const double r = p.norm();
  return {r > kOnIt ? Vector3d(p / r) : Vector3d::UnitZ(), r - sphere.radius};
}

Facing facing(const Cylinder& cylinder, const Vector3d& p) noexcept {
  const double r = p.head<2>().norm();
  const Vector2d out = r > kOnIt ? Vector2d(p.head<2>() / r) : Vector2d::UnitX();
  const double beside = r - cylinder.radius, above = std::abs(p.z()) - 0.5 * cylinder.length;
  const double side = std::copysign(1.0, p.z());
  if (beside > 0.0 && above > 0.0) {
    const double distance = std::hypot(beside, above);
    return {Vector3d(beside * out.x(), beside * out.y(), above * side) / distance, distance};
  }
  if (beside > above) return {Vector3d(out.x(), out.y(), 0.0), beside};
  return {side * Vector3d::UnitZ(), above};
}

Facing facing(const Triangle& triangle, const Vector3d& p) noexcept {
  const double height = triangle.normal.dot(p - triangle.corners[0]);
  if (height < -kBehind) return {};
  const Vector3d away = p - nearest_on(triangle, p);
  const double distance = away.norm();
  // over it, or touching it: the triangle's own plane, on either side
  if (distance <= std::abs(height) + kOnIt) {
    return {triangle.normal, height, -1, false, triangle.solid};
  }
  return height > 0.0 ? Facing{away / distance, distance, -1, true, triangle.solid} : Facing{};
}

Facing way_out(const Mesh& mesh, const Vector3d& p, double reach) noexcept {
  // usually near: search in growing distances
  for (double radius = std::min(2.0 * kBehind, reach);; radius = std::min(2.0 * radius, reach)) {
    Sides sides;
    mesh.for_each_near(p, p, radius, [&](const Triangle& triangle) {
      const Vector3d way = nearest_on(triangle, p) - p;
      const double distance = way.norm();
      Side* side = distance < radius ? sides.of(triangle.solid) : nullptr;
      if (side == nullptr) return;
      if (distance <= kOnIt || triangle.normal.dot(p - triangle.corners[0]) > 0.0) {
        side->front = std::min(side->front, distance);
      } else if (distance < std::abs(side->out.distance)) {
        side->out = {way / distance, -distance, -1, false, triangle.solid};
      }
    });
    if (const Side* around = sides.nearest_around()) return around->out;
    if (radius >= reach || (mesh.is_one_solid() && sides.has_front())) return {};
  }
}

bool FacingPlanes::covers(const Facing& edge) const noexcept {
  return std::ranges::any_of(planes_, [&](const Facing& plane) {
    if (plane.surface != edge.surface || plane.is_edge) return false;
    return plane.distance - edge.distance * plane.normal.dot(edge.normal) < kBent;
  });
}

void FacingPlanes::add(const Facing& facing, double to_spare) noexcept {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (planes_[i].surface < 0 || planes_[i].normal.dot(facing.normal) < kParallel) continue;
    if (to_spare >= to_spare_[i]) return;
    planes_[i] = facing;
    to_spare_[i] = to_spare;
    return;
  }
  const auto loosest = std::ranges::max_element(to_spare_);
  if (to_spare >= *loosest) return;
  planes_[loosest - to_spare_.begin()] = facing;
  *loosest = to_spare;
}

}  // namespace hg::surfaces

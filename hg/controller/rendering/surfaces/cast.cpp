#include "hg/controller/rendering/surfaces/cast.h"

#include <algorithm>
#include <cmath>

namespace hg::surfaces {
namespace {

using Eigen::Vector3d;

// The part of a path from `a` to `b` inside a convex solid, which is clipped by one side after the
// other.
class Clip {
 public:
  Clip(const Vector3d& a, const Vector3d& b) noexcept : a_(a), d_(b - a) {}

  // half-space: points at most `height` along the unit vector `normal`
  void flat(const Vector3d& normal, double height) noexcept {
    const double from = normal.dot(a_) - (height + kGrown);
    const double rise = normal.dot(d_);
    begin_at(from, rise, normal);
    if (rise == 0.0) {
      if (from > -kEntered) is_empty_ = true;
    } else if (rise < 0.0) {
      enter_at(-(from + kEntered) / rise, -from / rise, normal);
    } else {
      leave_at(-(from + kEntered) / rise);
    }
  }

  // points within `radius` of the origin, along the axes where `mask` is 1
  void round(const Vector3d& mask, double said_radius) noexcept {
    const double radius = said_radius + kGrown;
    const Vector3d a = mask.cwiseProduct(a_), d = mask.cwiseProduct(d_);
    const double distance = a.norm();
    const double slope = a.dot(d);
    begin_at(distance - radius, slope, a / std::max(distance, 1e-300));

    // |a + t d| = radius: A t^2 + 2 slope t + C = 0, in the form without cancellation
    const double A = d.squaredNorm();
    const double inner = radius - kEntered;
    const double C = (distance - inner) * (distance + inner);
    const double root = std::sqrt(std::max(0.0, slope * slope - A * C));
    if (C > 0.0) {
      if (slope >= 0.0 || slope * slope <= A * C) {
        is_empty_ = true;
        return;
      }
      const double C_surface = (distance - radius) * (distance + radius);
      const double stop = C_surface / (-slope + std::sqrt(slope * slope - A * C_surface));
      enter_at(C / (-slope + root), stop, (a + std::max(0.0, stop) * d).normalized());
      leave_at((-slope + root) / A);
    } else if (A > 0.0) {
      leave_at(slope > 0.0 ? -C / (slope + root) : (-slope + root) / A);
    }
  }

  // point where the path is stopped
  std::optional<Hit> hit() const noexcept {
    if (is_empty_) return {};
    if (enter_ <= 0.0) {
      // the path begins inside: no hit wherever it leaves; or on the surface but for rounding
      if (depth_ > kOutside || slope_ >= 0.0) return {};
      return Hit{0.0, nearest_};
    }
    if (enter_ >= std::min(1.0, leave_)) return {};
    return Hit{std::clamp(stop_, 0.0, 1.0), normal_};
  }
  // depth of the start point; negative outside
  double depth() const noexcept { return depth_; }

 private:
  void begin_at(double clearance, double slope, const Vector3d& normal) noexcept {
    if (-clearance >= depth_) return;
    depth_ = -clearance;
    slope_ = slope;
    nearest_ = normal;
  }
  void enter_at(double share, double stop, const Vector3d& normal) noexcept {
    if (share <= enter_) return;
    enter_ = share;
    stop_ = stop;
    normal_ = normal;
  }
  void leave_at(double share) noexcept { leave_ = std::min(leave_, share); }

  Vector3d a_, d_;
  bool is_empty_ = false;
  double enter_ = -kInfinity, leave_ = kInfinity, stop_ = 0.0;
  Vector3d normal_ = Vector3d::Zero();
  // values of the side nearest to the start point
  double depth_ = kInfinity, slope_ = 0.0;
  Vector3d nearest_ = Vector3d::Zero();
};

Clip clip(const Plane&, const Vector3d& a, const Vector3d& b) noexcept {
  Clip way(a, b);
  way.flat(Vector3d::UnitZ(), 0.0);
  return way;
}

Clip clip(const Box& box, const Vector3d& a, const Vector3d& b) noexcept {
  Clip way(a, b);
  for (int axis = 0; axis < 3; ++axis) {
    way.flat(Vector3d::Unit(axis), 0.5 * box.size[axis]);
    way.flat(-Vector3d::Unit(axis), 0.5 * box.size[axis]);
  }
  return way;
}

Clip clip(const Sphere& sphere, const Vector3d& a, const Vector3d& b) noexcept {
  Clip way(a, b);
  way.round(Vector3d::Ones(), sphere.radius);
  return way;
}

Clip clip(const Cylinder& cylinder, const Vector3d& a, const Vector3d& b) noexcept {
  Clip way(a, b);
  way.round(Vector3d(1.0, 1.0, 0.0), cylinder.radius);
  way.flat(Vector3d::UnitZ(), 0.5 * cylinder.length);
  way.flat(-Vector3d::UnitZ(), 0.5 * cylinder.length);
  return way;
}

std::optional<Hit> first_hit(const Mesh& mesh, const Vector3d& a, const Vector3d& b) noexcept {
  std::optional<Hit> first;
  mesh.for_each_near(a, b, 2.0 * kOutside, [&](const Triangle& triangle) {
    const double from = triangle.normal.dot(a - triangle.corners[0]);
    const double to = triangle.normal.dot(b - triangle.corners[0]);
    if (from < -kOutside || to > -kEntered || to >= from) return;
    const double share = std::max(0.0, from / (from - to));
    if (first && share >= first->share) return;
    if (is_over(triangle, a + share * (b - a), kSeam)) first = Hit{share, triangle.normal};
  });
  return first;
}

template <class Convex>
std::optional<Hit> first_hit(const Convex& solid, const Vector3d& a, const Vector3d& b) noexcept {
  return clip(solid, a, b).hit();
}

Vector3d into(const Pose& pose, const Vector3d& p) noexcept {
  return pose.R.transpose() * (p - pose.p);
}

bool is_on(const Mesh& mesh, const Vector3d& p) noexcept {
  bool is_near = false;
  mesh.for_each_near(p, p, kOutside, [&](const Triangle& triangle) {
    const bool is_in_plane = std::abs(triangle.normal.dot(p - triangle.corners[0])) <= kOutside;
    is_near = is_near || (is_in_plane && is_over(triangle, p, kOutside));
  });
  return is_near;
}

}  // namespace

std::optional<Hit> first_hit(const Surface& surface, const Vector3d& from,
                             const Vector3d& to) noexcept {
  const Vector3d a = into(surface.pose, from), b = into(surface.pose, to);
  std::optional<Hit> hit =
      std::visit([&](const auto& shape) { return first_hit(shape, a, b); }, surface.shape);
  if (hit) hit->normal = surface.pose.R * hit->normal;
  return hit;
}

bool is_inside(const Surface& surface, const Vector3d& point) noexcept {
  const Vector3d p = into(surface.pose, point);
  return std::visit(
      [&](const auto& shape) {
        if constexpr (std::is_same_v<decltype(shape), const Mesh&>) {
          return shape.is_closed() && !is_on(shape, p) && shape.encloses(p);
        } else {
          return clip(shape, p, p).depth() > kOutside;
        }
      },
      surface.shape);
}

}  // namespace hg::surfaces

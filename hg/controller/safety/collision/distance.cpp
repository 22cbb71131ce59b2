#include "hg/controller/safety/collision/distance.h"

#include <coal/distance.h>
#include <coal/shape/geometric_shapes.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hg::collision {

struct Distance::Capsules {
  Capsules(const Shape& first, const Shape& second)
      : a(first.radius, 2.0 * first.half_length),
        b(second.radius, 2.0 * second.half_length),
        compute(&a, &b) {}

  coal::Capsule a, b;
  coal::ComputeDistance compute;
  coal::DistanceRequest request;
};

Distance::Distance(const Shape& a, const Shape& b) : a_(a), b_(b) {
  if (a_.is_box && b_.is_box) {
    Shape& smaller = reach(a_) < reach(b_) ? a_ : b_;
    smaller = capsule_around(smaller);
  }
  if (a_.is_box) {
    std::swap(a_, b_);
    is_swapped_ = true;
  }
  if (!b_.is_box) capsules_ = std::make_unique<Capsules>(a_, b_);
}

Distance::Distance(const Distance& other)
    : a_(other.a_), b_(other.b_), is_swapped_(other.is_swapped_) {
  if (!b_.is_box) capsules_ = std::make_unique<Capsules>(a_, b_);
}
Distance::Distance(Distance&& other) noexcept = default;
Distance& Distance::operator=(Distance other) noexcept {
  std::swap(a_, other.a_);
  std::swap(b_, other.b_);
  std::swap(is_swapped_, other.is_swapped_);
  std::swap(capsules_, other.capsules_);
  return *this;
}
Distance::~Distance() = default;

double Distance::operator()(const Pose& T_B_a, const Pose& T_B_b) const noexcept {
  return witnesses(T_B_a, T_B_b).distance;
}

Distance::Witnesses Distance::witnesses(const Pose& T_B_a, const Pose& T_B_b) const noexcept {
  const Pose a = (is_swapped_ ? T_B_b : T_B_a) * a_.T_frame_shape;
  const Pose b = (is_swapped_ ? T_B_a : T_B_b) * b_.T_frame_shape;
  Witnesses found;
  if (capsules_) {
    coal::DistanceResult result;
    found.distance = capsules_->compute(coal::Transform3s(a.R, a.p), coal::Transform3s(b.R, b.p),
                                        capsules_->request, result);
    found.a = result.nearest_points[0];
    found.b = result.nearest_points[1];
    return found;
  }
  const Eigen::Vector3d centre = b.R.transpose() * (a.p - b.p);
  const Eigen::Vector3d half = b.R.transpose() * a.R.col(2) * a_.half_length;
  const double place = nearest_on_segment(centre - half, centre + half, b_.half_edges);
  const Eigen::Vector3d on_segment = centre + (2.0 * place - 1.0) * half;
  const Eigen::Vector3d on_box = on_segment.cwiseMax(-b_.half_edges).cwiseMin(b_.half_edges);
  const double apart = (on_segment - on_box).norm();
  found.distance = apart - a_.radius;
  found.a = b.p + b.R * on_segment;
  if (apart > 0.0) found.a += b.R * (on_box - on_segment) * (a_.radius / apart);
  found.b = b.p + b.R * on_box;
  if (is_swapped_) std::swap(found.a, found.b);
  return found;
}

namespace {

// Largest coordinate along `direction` of a shape whose frame is at `T`, all in one frame.
double farthest(const Shape& shape, const Pose& T, const Eigen::Vector3d& direction) noexcept {
  const Pose at = T * shape.T_frame_shape;
  const Eigen::Vector3d local = at.R.transpose() * direction;
  const double half = shape.is_box ? local.cwiseAbs().dot(shape.half_edges)
                                   : std::abs(local.z()) * shape.half_length + shape.radius;
  return at.p.dot(direction) + half;
}

// from the box |x_i| <= half_i to `x`
Eigen::Vector3d outside(const Eigen::Vector3d& x, const Eigen::Vector3d& half) noexcept {
  return x - x.cwiseMax(-half).cwiseMin(half);
}

}  // namespace

double Distance::between_planes(const Eigen::Vector3d& along, const Pose& T_a_b) const noexcept {
  const Shape& first = is_swapped_ ? b_ : a_;
  const Shape& second = is_swapped_ ? a_ : b_;
  return -farthest(second, T_a_b, -along) - farthest(first, Pose{}, along);
}

double nearest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                          const Eigen::Vector3d& half) noexcept {
  const Eigen::Vector3d d = q - p;
  const auto slope_at = [&](double t) { return outside(p + t * d, half).dot(d); };
  // the square of the distance is convex in t, its slope linear between these places, in order
  std::array<double, 8> place = {0.0, 1.0};
  std::size_t count = 2;
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0.0) continue;
    for (const double side : {-half[i], half[i]}) {
      const double t = (side - p[i]) / d[i];
      if (!(t > 0.0 && t < 1.0)) continue;
      std::size_t at = count++;
      for (; place[at - 1] > t; --at) place[at] = place[at - 1];
      place[at] = t;
    }
  }

  double t_before = 0.0;
  double slope_before = slope_at(0.0);
  if (slope_before >= 0.0) return 0.0;
  for (std::size_t i = 1; i < count; ++i) {
    const double slope = slope_at(place[i]);
    if (slope >= 0.0) {
      const double share = slope_before / (slope_before - slope);
      return t_before + share * (place[i] - t_before);
    }
    t_before = place[i];
    slope_before = slope;
  }
  return 1.0;
}

}  // namespace hg::collision

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
  const Pose a = (is_swapped_ ? T_B_b : T_B_a) * a_.T_frame_shape;
  const Pose b = (is_swapped_ ? T_B_a : T_B_b) * b_.T_frame_shape;
  if (capsules_) {
    coal::DistanceResult result;
    return capsules_->compute(coal::Transform3s(a.R, a.p), coal::Transform3s(b.R, b.p),
                              capsules_->request, result);
  }
  const Eigen::Vector3d centre = b.R.transpose() * (a.p - b.p);
  const Eigen::Vector3d half = b.R.transpose() * a.R.col(2) * a_.half_length;
  return segment_to_box(centre - half, centre + half, b_.half_edges) - a_.radius;
}

double segment_to_box(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                      const Eigen::Vector3d& half) noexcept {
  const Eigen::Vector3d d = q - p;
  const auto outside = [&](double t) -> Eigen::Vector3d {
    const Eigen::Vector3d x = p + t * d;
    return x - x.cwiseMax(-half).cwiseMin(half);
  };
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
  double slope_before = outside(0.0).dot(d);
  if (slope_before >= 0.0) return outside(0.0).norm();
  for (std::size_t i = 1; i < count; ++i) {
    const double slope = outside(place[i]).dot(d);
    if (slope >= 0.0) {
      const double share = slope_before / (slope_before - slope);
      return outside(t_before + share * (place[i] - t_before)).norm();
    }
    t_before = place[i];
    slope_before = slope;
  }
  return outside(1.0).norm();
}

}  // namespace hg::collision

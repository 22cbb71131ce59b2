/// The distance between two shapes, exact and without allocation.
///
/// Two capsules: Coal's ComputeDistance. A capsule and a box: closed form, because Coal's way
/// allocates; the tests compare it with Coal. Of two boxes the smaller one counts as the capsule
/// around it. One object serves one thread.
#pragma once

#include <memory>

#include "hg/controller/safety/collision/shapes.h"

namespace hg::collision {

class Distance {
 public:
  Distance(const Shape& a, const Shape& b);
  Distance(const Distance& other);
  Distance(Distance&& other) noexcept;
  Distance& operator=(Distance other) noexcept;
  ~Distance();

  /// Distance with the frames of the shapes at these poses, m; negative or zero where they touch.
  double operator()(const Pose& T_B_a, const Pose& T_B_b) const noexcept;

  /// The points of both shapes that are nearest to each other, in B; inside the shapes where they
  /// overlap.
  struct Witnesses {
    Eigen::Vector3d a, b;
    double distance = 0.0;  ///< m
  };
  Witnesses witnesses(const Pose& T_B_a, const Pose& T_B_b) const noexcept;

  /// How far apart planes across the unit vector `along`, in the frame of `a`, hold the shapes with
  /// `b` at T_a_b, m: never more than their distance, and as much where `along` leads from witness
  /// to witness. Both poses are those of the frames that the shapes are fixed to.
  double between_planes(const Eigen::Vector3d& along, const Pose& T_a_b) const noexcept;

 private:
  struct Capsules;

  Shape a_, b_;  // b_ is the box, if there is one
  bool is_swapped_ = false;
  std::unique_ptr<Capsules> capsules_;
};

/// Where on the segment from `p` (0) to `q` (1) it is nearest to the box |x_i| <= half_i around the
/// origin.
double nearest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                          const Eigen::Vector3d& half) noexcept;

}  // namespace hg::collision

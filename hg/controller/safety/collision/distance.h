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

 private:
  struct Capsules;

  Shape a_, b_;  // b_ is the box, if there is one
  bool is_swapped_ = false;
  std::unique_ptr<Capsules> capsules_;
};

/// Distance from the segment between `p` and `q` to the box |x_i| <= half_i around the origin, m.
double segment_to_box(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                      const Eigen::Vector3d& half) noexcept;

}  // namespace hg::collision

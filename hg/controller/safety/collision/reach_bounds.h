/// Bounds on how far joints can move the core of a shape, valid in every posture: of a capsule its
/// segment, of a box all of it. Distances change by no more. Set-up only.
#pragma once

#include <vector>

#include "hg/controller/safety/collision/shapes.h"
#include "hg/core/interval.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"

namespace hg::collision {

/// Joints of a chain at its neutral posture.
class ReachBounds {
 public:
  /// `range`: range of each joint; a prismatic joint shifts the bodies behind it that far.
  ReachBounds(model::ChainModel chain, std::vector<Interval> range);

  /// Bounds as in Pair::lever for `shape` as seen from body `from`.
  VectorPM of(const Shape& shape, int from) const;

 private:
  double lever(int joint, const Shape& shape) const;

  model::ChainData chain_;
  std::vector<double> stroke_;           // stroke of prismatic joints, else 0
  std::vector<Eigen::Vector3d> origin_;  // joint origins in B
  std::vector<Eigen::Vector3d> axis_;    // joint axes in B
};

}  // namespace hg::collision

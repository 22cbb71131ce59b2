/// How far joints can move points of a shape: bounds that hold in every posture. Set-up only.
#pragma once

#include <vector>

#include "hg/collision/shapes.h"
#include "hg/core/interval.h"
#include "hg/core/stacked.h"

namespace hg::collision {

/// Joints of a chain at its neutral posture.
class Levers {
 public:
  /// `range` of each joint: prismatic joints carry what is behind them that far.
  Levers(model::Chain chain, std::vector<Interval> range);

  /// Bounds as in Pair::lever for `shape` as seen from body `from`.
  VectorPM of(const Shape& shape, int from) const;

 private:
  double lever(int joint, const Shape& shape) const;

  model::Chain chain_;
  std::vector<double> stroke_;           // of prismatic joints, else 0
  std::vector<Eigen::Vector3d> origin_;  // in B
  std::vector<Eigen::Vector3d> axis_;    // in B
};

}  // namespace hg::collision

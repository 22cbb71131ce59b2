/// The smallest distance of the watched pairs of a device in a posture. For set-up and tests: the
/// control loop has its guard.
#pragma once

#include <vector>

#include "hg/controller/safety/collision/distance.h"
#include "hg/controller/safety/collision/pairs.h"
#include "hg/controller/safety/collision/shapes.h"
#include "hg/model/chain_data.h"

namespace hg::collision {

class Nearest {
 public:
  /// `watched`: pairs of `shapes`.
  Nearest(const std::vector<Shape>& shapes, const std::vector<Pair>& watched);

  /// Distance in the posture of `chain`, m; negative or zero where shapes touch, infinite without
  /// pairs.
  double distance(const model::ChainData& chain) const;

 private:
  struct Watched {
    int frame_a, frame_b;  // of the chain; -1 = B
    Distance distance;
  };

  std::vector<Watched> pairs_;
};

}  // namespace hg::collision

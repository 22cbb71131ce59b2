/// Set-up data of the guard against collisions.
#pragma once

#include <vector>

#include "hg/controller/safety/collision/pairs.h"
#include "hg/controller/safety/collision/shapes.h"

namespace hg::collision {

/// Set-up data.
struct CollisionConfig {
  std::vector<Shape> shapes;    ///< Collision shapes; empty: nothing is watched
  Pairs pairs;                  ///< Pairs found by choose_pairs()
  double safe_distance = 0.03;  ///< Safe distance, [HANDBOOK] 6.4, m
};

}  // namespace hg::collision

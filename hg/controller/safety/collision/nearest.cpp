#include "hg/controller/safety/collision/nearest.h"

#include <algorithm>

#include "hg/core/interval.h"

namespace hg::collision {

Nearest::Nearest(const std::vector<Shape>& shapes, const std::vector<Pair>& watched) {
  for (const Pair& pair : watched) {
    const Shape &a = shapes[pair.a], &b = shapes[pair.b];
    pairs_.push_back({a.frame, b.frame, Distance(a, b)});
  }
}

double Nearest::distance(const model::ChainData& chain) const {
  const auto pose = [&](int frame) { return frame < 0 ? Pose{} : chain.pose(frame); };
  double smallest = kInfinity;
  for (const Watched& pair : pairs_) {
    smallest = std::min(smallest, pair.distance(pose(pair.frame_a), pose(pair.frame_b)));
  }
  return smallest;
}

}  // namespace hg::collision

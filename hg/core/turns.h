/// Counts how often a signal in space turns round: what swings does so again and again, a push or
/// an impact does not.
///
/// State of a filter: copyable, no allocation, noexcept.
#pragma once

#include <Eigen/Core>

namespace hg {

struct Turns {
  Eigen::Vector3d farthest = Eigen::Vector3d::Zero();  ///< since it last turned
  double since_s = 0.0;                                ///< since it last turned
  int count = 0;                                       ///< without a pause

  /// Smaller values than `least` do not count; after `pause_s` without a turn it begins anew.
  void step(const Eigen::Vector3d& x, double least, double dt, double pause_s) noexcept {
    since_s += dt;
    if (since_s > pause_s) *this = {};
    if (!(x.norm() > least)) return;
    if (x.dot(farthest) < 0.0) {
      farthest = x;
      since_s = 0.0;
      ++count;
    } else if (x.squaredNorm() > farthest.squaredNorm()) {
      if (farthest.isZero(0.0)) since_s = 0.0;
      farthest = x;
    }
  }
};

}  // namespace hg

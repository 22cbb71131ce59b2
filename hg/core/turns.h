/// Counts reversals of a 3D signal: an oscillation reverses repeatedly, a push or an impact does
/// not.
///
/// State of a filter: copyable, no allocation, noexcept.
#pragma once

#include <Eigen/Core>

namespace hg {

/// Counter of reversals.
struct Turns {
  Eigen::Vector3d farthest = Eigen::Vector3d::Zero();  ///< Largest value since the last reversal
  double since_s = 0.0;                                ///< Time since the last reversal, s
  int count = 0;                                       ///< Reversals without a pause

  /// Adds a sample. Ignores values below `least`; resets after `pause_s` without a reversal.
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

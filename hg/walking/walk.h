/// A walk along a path with a method in a room, and its figures.
#pragma once

#include <functional>
#include <vector>

#include "hg/walking/redirection.h"

namespace hg::walking {

/// Thresholds from which on people notice [Steinicke et al. 2010].
inline constexpr double kNoticedRadius = 22.0;               ///< m
inline constexpr double kLeastTurn = 0.8, kMostTurn = 1.49;  ///< in the room over what is seen

struct WalkFigures {
  double length = 0.0;    ///< of the way in the target environment, m
  double duration = 0.0;  ///< s
  int resets = 0;
  double clearance = 0.0;  ///< smallest distance to a wall, m; negative: beyond it
  double way_gain_least = 1.0, way_gain_most = 1.0;  ///< of what is seen over what is walked
  double turn_rate = 0.0;  ///< largest speed at which the target environment turns, rad/s
  double bent = 0.0;       ///< way with a curvature beyond kNoticedRadius, m
  double twisted = 0.0;    ///< turns scaled by more than kLeastTurn to kMostTurn, of all turns
  /// Deviation of curvature at each sample of a person who walks, 1/m, and its way, m; sorted
  std::vector<std::pair<double, double>> bends;

  void add(const WalkFigures& other);
  /// Curvature below which this share of the way is, 1/m.
  double bend_quantile(double share) const;
};

/// Where the person is in the room at every sample, after it.
using WalkObserver = std::function<void(const WalkMoment&, const PlanarPose&)>;

/// Begins in the middle of the room, facing +x.
WalkFigures walk(const WalkedPath& path, Redirector& redirector, const WalkRoom& room,
                 const WalkObserver& observe = {});

}  // namespace hg::walking

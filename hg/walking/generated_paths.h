/// Paths that are made of a seed: through buildings, and the families of OpenRDW.
///
/// A person goes straight with 1 m/s and turns in place with 90 degrees per second, as the
/// simulated walker of OpenRDW [Li et al., IEEE VR 2021].
#pragma once

#include "hg/core/random.h"
#include "hg/walking/walked_path.h"

namespace hg::walking {

/// With the parameters of OpenRDW.
enum class PathFamily {
  kRightAngles,  ///< 40 ways of 2 to 8 m, after each a turn by 90 degrees to a random side
  kRandomTurns,  ///< 50 ways of 2 to 8 m, after each a turn by up to 180 degrees
  kStraight,     ///< 200 m
};

WalkedPath make_path(PathFamily family, Random& random);

/// Through up to ten rooms (3 to 7 m) and corridors (1.6 to 2.4 m by 4 to 12 m) and the doors
/// between them (0.9 m). At each door the person stops for 2 s before the closed leaf; in each room
/// at one more place for 1 s.
WalkedPath make_building(Random& random);

}  // namespace hg::walking

/// Selects the pairs of shapes to watch and bounds how fast joints can bring them together.
///
/// Set-up only: samples the whole range of the joints with a fixed seed, so that the same device
/// always has the same pairs.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/controller/safety/collision/shapes.h"
#include "hg/core/interval.h"
#include "hg/core/stacked.h"

namespace hg::collision {

/// Two shapes, indices into the list; the joints between them move `b`.
struct Pair {
  int a = 0;
  int b = 0;
  /// Bound per joint on the speed of any point of `b` without its radius relative to `a`, per unit
  /// of joint speed, in every posture: m/rad, or 1 for a prismatic joint between the two, 0 for
  /// others.
  VectorPM lever;
};

enum class Exclusion : std::uint8_t {
  kNeighbours,  ///< only one joint is between them: they touch there by design
  kAlways,      ///< touch in every posture
  kNever,       ///< never come near each other within the range of the joints
  kGiven,       ///< left out by the file of the device
};

struct Excluded {
  int a = 0;
  int b = 0;
  Exclusion reason = Exclusion::kNever;
  double distance = 0.0;  ///< Smallest distance found (kNever) or largest (kAlways), m
};

struct Pairs {
  std::vector<Pair> watched;
  std::vector<Excluded> excluded;
};

/// Pairs of shapes that may come nearer than `near` (m) within `range` (per joint; joints without
/// limits turn once). A pair is left out as kNever when neither samples of the whole range nor a
/// search from the best of them come that near.
Pairs choose_pairs(const std::vector<Shape>& shapes, const model::ChainModel& chain,
                   const std::vector<Interval>& range, double near);

}  // namespace hg::collision

/// Whether meshes of an arm can touch. Set-up only: allocates.
#pragma once

#include <cstddef>
#include <map>
#include <tuple>
#include <vector>

#include "hg/controller/safety/collision/reach_bounds.h"
#include "hg/core/interval.h"
#include "hg/model/chain_data.h"
#include "hg/new/bodies.h"

namespace hg::new_files {

inline constexpr double kMeshMargin = 0.005;  ///< Between meshes that never touch, m

/// Two parts of two bodies, by the joints of the bodies and the numbers of the parts.
using PartPair = std::tuple<int, int, int, int>;
PartPair pair_of(const Body& a, std::size_t i, const Body& b, std::size_t k);

/// Proves for parts of two bodies with two joints between them that their meshes stay apart:
/// between two postures of these joints, a distance changes by at most lever times angle. Answers
/// are kept.
class Clearance {
 public:
  /// `ranges`: of the joints of `chain`.
  Clearance(const model::ChainModel& chain, const std::vector<Interval>& ranges);

  /// Whether the meshes of part `i` of `a` and part `k` of `b` are proven to stay kMeshMargin apart
  /// in every posture. `a` comes before `b` in the chain.
  bool is_proven(const Body& a, std::size_t i, const Body& b, std::size_t k);

 private:
  bool prove(const Body& a, std::size_t i, const Body& b, std::size_t k);

  model::ChainData chain_;
  std::vector<Interval> ranges_;
  collision::ReachBounds levers_;
  std::map<PartPair, bool> known_;
};

/// Whether the meshes of two parts are within kMeshMargin of each other, or touch, with the frames
/// of their bodies at these poses.
bool touches(const Part& a, const Pose& T_B_a, const Part& b, const Pose& T_B_b);

}  // namespace hg::new_files

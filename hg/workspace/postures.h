/// Random postures of a chain and properties of its Jacobian there.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/random.h"
#include "hg/model/chain_data.h"

namespace hg::workspace {

/// Draws coordinates of scalar joints. The same seed gives the same postures everywhere.
class PostureSampler {
 public:
  /// Joints without limits are drawn from one turn (rad) or from -1..1 m.
  explicit PostureSampler(std::vector<Interval> ranges, std::uint32_t seed = 1);

  Eigen::VectorXd draw();

 private:
  std::vector<Interval> ranges_;
  Random32 random_;
};

/// Position ranges of the chain's joints, one per joint; floating joints are not supported.
std::vector<Interval> joint_ranges(const model::ChainModel& chain);

/// Smallest singular value of the Jacobian (columns from `first`) at `frame`, rotations scaled by
/// 0.3 m, about the size of a wrist; m/rad. 0 where a direction of motion is lost. Moves `chain`
/// to `q`.
double dexterity(model::ChainData& chain, int frame, int first, const Eigen::VectorXd& q);

/// A joint, or the sum of two neighbours, that is singular at `value` for all positions of the
/// others.
struct SingularValue {
  int joint = 0;
  int other = -1;  ///< second joint of the sum; -1 = `joint` alone
  double value = 0.0;
};

/// Finds the singular values of joints, and of sums of neighbours, from `first` on, in their
/// ranges: multiples of a quarter turn, and others, as that of an elbow beside a forearm that is
/// offset. Earlier joints are ignored.
std::vector<SingularValue> singular_values(const model::ChainModel& chain, int frame, int first,
                                           const std::vector<Interval>& ranges);

}  // namespace hg::workspace

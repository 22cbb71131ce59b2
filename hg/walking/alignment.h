/// ARC, the alignment-based redirection controller [Williams, Bera, Manocha 2021]: free distances
/// ahead and to both sides are made alike in the room and in the target environment.
///
/// Gains and smoothing are those of the authors' program.
#pragma once

#include "hg/walking/redirection.h"

namespace hg::walking {

class Alignment : public Redirector {
 public:
  explicit Alignment(const WalkRoom& room) : room_(room) {}
  Redirection step(const WalkMoment& moment) noexcept override;
  /// Of 20 directions away from the wall, the one with the most similar free distance ahead, first
  /// of those with at least as much as in the target environment.
  double heading_after_reset(const WalkMoment& moment) noexcept override;

 private:
  double in_room(const WalkMoment& moment, double angle) const noexcept;

  WalkRoom room_;
  double turn_gain_ = 1.0;
  double last_misalignment_ = -1.0;  ///< m; negative: none yet
};

}  // namespace hg::walking

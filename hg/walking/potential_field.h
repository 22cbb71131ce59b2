/// Artificial potential field: each wall repels [Thomas, Rosenberg 2019], with the gains of
/// OpenRDW. A reset turns the person to where the walls push.
#pragma once

#include "hg/walking/redirection.h"

namespace hg::walking {

class PotentialField : public Redirector {
 public:
  explicit PotentialField(const Rectangle& room) : room_(room) {}
  Redirection step(const WalkMoment& moment) noexcept override;
  double heading_after_reset(const WalkMoment& moment) noexcept override;

 private:
  Eigen::Vector2d push(const Eigen::Vector2d& p) const noexcept;

  Rectangle room_;
};

}  // namespace hg::walking

/// Steer to center [Razzaque 2005], with target, damping and smoothing of the Redirected Walking
/// Toolkit [Azmandian, Grechkin, Bolas, Suma 2016].
#pragma once

#include "hg/walking/redirection.h"

namespace hg::walking {

class SteerToCenter : public Redirector {
 public:
  explicit SteerToCenter(const Rectangle& room) : center_(room.middle()) {}
  Redirection step(const WalkMoment& moment) noexcept override;
  double heading_after_reset(const WalkMoment& moment) noexcept override;

 private:
  Eigen::Vector2d target(const WalkMoment& moment) noexcept;

  Eigen::Vector2d center_;
  Eigen::Vector2d aside_ = Eigen::Vector2d::Zero();  ///< target while the center is behind
  bool has_aside_ = false;
  double applied_ = 0.0;  ///< at the last sample, rad
};

}  // namespace hg::walking

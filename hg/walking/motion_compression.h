/// Motion compression [Nitzsche, Hanebeck, Schmidt 2004]: the way in the room has the length and
/// the turns of the way in the target environment, and the least deviation of curvature.
///
/// Path prediction, path transformation (path_planner.h) and user guidance: while a person walks at
/// speed v, the target environment turns about the person by -u v, with the u of the last plan. A
/// new plan is made every 0.1 m of the way and after turns of 0.1 rad.
#pragma once

#include <cstdint>

#include "hg/walking/path_planner.h"
#include "hg/walking/redirection.h"

namespace hg::walking {

enum class Prediction : std::uint8_t {
  kStraight,  ///< on in the direction that the person faces
  kRoute,     ///< the path itself, as if the person's goals were known
};

class MotionCompression : public Redirector {
 public:
  MotionCompression(const PlannerConfig& config, Prediction prediction)
      : prediction_(prediction), largest_bend_(1.25 * config.largest_bend), planner_(config) {}
  Redirection step(const WalkMoment& moment) noexcept override;
  double heading_after_reset(const WalkMoment& moment) noexcept override;

 private:
  void plan(const WalkMoment& moment) noexcept;

  Prediction prediction_;
  double largest_bend_;  ///< 1/m, also where a plan goes further
  PathPlanner planner_;
  double u_ = 0.0, w_ = 0.0;  ///< deviation of curvature and its slope, 1/m and 1/m^2
  double since_ = 0.0;        ///< way since the last plan, m
  double heading_ = 0.0;      ///< of the person in the target environment at the last plan, rad
  bool has_plan_ = false;
};

}  // namespace hg::walking

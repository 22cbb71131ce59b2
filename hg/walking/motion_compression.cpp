#include "hg/walking/motion_compression.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hg::walking {
namespace {

double turn_between(double from, double to) noexcept {
  return std::remainder(to - from, 2.0 * std::numbers::pi);
}

// Turns of the path in each step of its way from a sample on.
PathPlanner::Turns route_ahead(const WalkedPath& path, std::size_t index) noexcept {
  PathPlanner::Turns turns{};
  double s = 0.0;
  for (std::size_t i = index + 1; i < path.samples.size(); ++i) {
    s += path.samples[i].v.norm() * kWalkPeriod;
    const int k = static_cast<int>(s / PathPlanner::kStep);
    if (k >= PathPlanner::kSteps) break;
    turns[k] += turn_between(path.samples[i - 1].heading, path.samples[i].heading);
  }
  return turns;
}

}  // namespace

void MotionCompression::plan(const WalkMoment& moment) noexcept {
  PathPlanner::Turns turns{};
  if (prediction_ == Prediction::kRoute) turns = route_ahead(moment.path, moment.index);
  const PathState state(moment.room.p.x(), moment.room.p.y(), moment.room.heading + moment.turn(),
                        u_, w_);
  planner_.plan(state, turns, static_cast<int>(std::lround(since_ / PathPlanner::kStep)));
  since_ = 0.0;
  heading_ = moment.sample().heading;
  has_plan_ = true;
}

Redirection MotionCompression::step(const WalkMoment& moment) noexcept {
  constexpr double kTurned = 0.1;  // rad
  const double turned = std::abs(turn_between(heading_, moment.sample().heading));
  if (!has_plan_ || since_ >= PathPlanner::kStep || turned > kTurned) plan(moment);
  const double ds = moment.sample().v.norm() * kWalkPeriod;
  const PathState next = moved(PathState(0, 0, 0, u_, w_), planner_.control(since_), 0.0, ds);
  const double last = u_;
  since_ += ds;
  u_ = std::clamp(next[3], -largest_bend_, largest_bend_);
  w_ = u_ == next[3] ? next[4] : 0.0;
  return {.bend = ds * 0.5 * (last + u_)};
}

double MotionCompression::heading_after_reset(const WalkMoment& moment) noexcept {
  has_plan_ = false;
  u_ = w_ = 0.0;
  return Redirector::heading_after_reset(moment);
}

}  // namespace hg::walking

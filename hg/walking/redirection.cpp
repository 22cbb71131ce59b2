#include "hg/walking/redirection.h"

#include <cmath>
#include <numbers>

#include "hg/walking/alignment.h"
#include "hg/walking/motion_compression.h"
#include "hg/walking/potential_field.h"
#include "hg/walking/steer_to_center.h"

namespace hg::walking {
namespace {

class NoRedirection : public Redirector {
 public:
  Redirection step(const WalkMoment&) noexcept override { return {}; }
};

}  // namespace

double WalkMoment::turn() const noexcept {
  return std::remainder(sample().heading - last().heading, 2.0 * std::numbers::pi);
}

double Redirector::heading_after_reset(const WalkMoment& moment) noexcept {
  return moment.room.heading + std::numbers::pi;
}

bool WalkRoom::needs_reset(const PlanarPose& pose) const noexcept {
  constexpr double kTowards = 1e-3;
  const Rectangle free = walls.inset(buffer);
  const Eigen::Vector2d direction = direction_of(pose.heading);
  for (int i = 0; i < 2; ++i) {
    if (pose.p[i] <= free.lower[i] && direction[i] < -kTowards) return true;
    if (pose.p[i] >= free.upper[i] && direction[i] > kTowards) return true;
  }
  return false;
}

std::unique_ptr<Redirector> make_redirector(RedirectionKind kind, const WalkRoom& room) {
  const Rectangle& walls = room.walls;
  constexpr double kSpare = 0.25;  // m, for those who turn to a wall without notice
  const PlannerConfig config = {.room = walls.inset(room.buffer + kSpare)};
  switch (kind) {
    case RedirectionKind::kNone:
      break;
    case RedirectionKind::kSteerToCenter:
      return std::make_unique<SteerToCenter>(walls);
    case RedirectionKind::kPotentialField:
      return std::make_unique<PotentialField>(walls);
    case RedirectionKind::kAlignment:
      return std::make_unique<Alignment>(room);
    case RedirectionKind::kMotionCompression:
      return std::make_unique<MotionCompression>(config, Prediction::kStraight);
    case RedirectionKind::kKnownRoute:
      return std::make_unique<MotionCompression>(config, Prediction::kRoute);
  }
  return std::make_unique<NoRedirection>();
}

}  // namespace hg::walking

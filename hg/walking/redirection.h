/// Methods that lead a person who walks through a target environment round inside a room.
///
/// At every sample of a path a method says how the person's motion in the room differs from that in
/// the target environment: by a rotation of the direction in which the person walks and faces, and
/// by the length of the way. What the person sees moves by the opposite. Angles are positive to the
/// left, in rad.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "hg/walking/walked_path.h"

namespace hg::walking {

enum class RedirectionKind : std::uint8_t {
  kNone,
  kSteerToCenter,      ///< [Razzaque 2005], as in the Redirected Walking Toolkit
  kPotentialField,     ///< [Thomas, Rosenberg 2019]
  kAlignment,          ///< ARC [Williams, Bera, Manocha 2021]
  kMotionCompression,  ///< [Nitzsche, Hanebeck, Schmidt 2004]; a person is expected to go straight
  kKnownRoute,         ///< the same where the next 4 m of the person's path are known
};

/// Position and heading in a plane, m and rad.
struct PlanarPose {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  double heading = 0.0;
};

/// What a method sees: the path as far as `index`, and the pose in the room before that sample.
struct WalkMoment {
  const WalkedPath& path;
  std::size_t index = 1;  ///< at least 1
  PlanarPose room;

  const WalkSample& sample() const noexcept { return path.samples[index]; }
  const WalkSample& last() const noexcept { return path.samples[index - 1]; }
  double distance() const noexcept { return (sample().p - last().p).norm(); }  ///< m
  double turn() const noexcept;                                                ///< rad
};

struct Redirection {
  double bend = 0.0;    ///< rotation because of walking, rad
  double twist = 0.0;   ///< rotation because of turning, rad
  double length = 1.0;  ///< way in the room over that in the target environment
};

class Redirector {
 public:
  virtual ~Redirector() = default;
  virtual Redirection step(const WalkMoment& moment) noexcept = 0;
  /// Heading in the room after a reset; the person turns there while the target environment seems
  /// to have turned once. Without a method of its own: half a turn.
  virtual double heading_after_reset(const WalkMoment& moment) noexcept;
};

/// The room of the device, and where a person is stopped and turned.
struct WalkRoom {
  Rectangle walls = centered(3.3, 3.9);  ///< m
  /// From a wall to where a person who walks on is stopped and turned (a reset), m: that of OpenRDW
  double buffer = 0.5;

  /// Whether a person within the buffer heads for its wall.
  bool needs_reset(const PlanarPose& pose) const noexcept;
};

std::unique_ptr<Redirector> make_redirector(RedirectionKind kind, const WalkRoom& room);

}  // namespace hg::walking

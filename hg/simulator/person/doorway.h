/// A doorway with a leaf that opens away from a person, and the room that it leaves for a body.
///
/// Frame of the doorway: origin on the hinge axis, x along the closed leaf, y the way it opens;
/// the leaf is at the angle of its hinge, from x towards y. SI units. noexcept after set-up.
#pragma once

#include "hg/core/types.h"
#include "hg/model/chain_model.h"

namespace hg::person {

/// Half of a person's breadth across the shoulders, m: 0.51 m in the mean of men in ANSUR II [K].
inline constexpr double kHalfBreadth = 0.25;

struct Doorway {
  int joint = 0;              ///< the hinge among the joints of the twin
  double leaf_width = 0.92;   ///< of the leaf, from the hinge axis, m
  double clear_width = 0.93;  ///< from the hinge axis to the opposite side of the frame, m
  double start_s = 1.5;       ///< when the person sets out, since the grasp, s
  double beyond = 1.8;        ///< where the body stops, along y, m

  // found by place()
  Eigen::Vector2d hinge = Eigen::Vector2d::Zero();   ///< hinge axis in B
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< x of the doorway in B
  Eigen::Vector2d away = Eigen::Vector2d::UnitY();   ///< y of the doorway in B
  double handle_radius = 0.75;                       ///< of the handle along the leaf, m
  double handle_offset = 0.0;                        ///< of the handle before the leaf, m

  /// A point of B in the frame of the doorway.
  Eigen::Vector2d local(const Eigen::Vector2d& p_B) const noexcept {
    return {along.dot(p_B - hinge), away.dot(p_B - hinge)};
  }
};

/// Finds the doorway of a twin whose hand axis, z of frame `end_effector`, stands at right angles
/// on the leaf, from the posture of the twin with all joints at 0: shut. Throws SetupError unless
/// joint `doorway.joint` is a vertical hinge that opens away from the person as its angle grows.
void place(Doorway& doorway, const model::ChainModel& twin, int end_effector);

/// Angle of the leaf whose handle is at `p_H` in B, rad.
double leaf_angle(const Doorway& doorway, const Eigen::Vector3d& p_H) noexcept;

/// Distance of the point `p` of the doorway to the middle of a leaf at `angle`, m.
double leaf_distance(const Doorway& doorway, double angle, const Eigen::Vector2d& p) noexcept;

/// Distance of the point `p` of the doorway to the frame at either side, m.
double frame_distance(const Doorway& doorway, const Eigen::Vector2d& p) noexcept;

/// Smallest angle from which on the leaf leaves `room` around the point `p` of the doorway; 0 if it
/// always does.
double angle_needed(const Doorway& doorway, const Eigen::Vector2d& p, double room) noexcept;

/// Whether a leaf that falls shut cannot come nearer than `room` to the point `p` behind it.
bool is_clear_of_leaf(const Doorway& doorway, const Eigen::Vector2d& p, double room) noexcept;

}  // namespace hg::person

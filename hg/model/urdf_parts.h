/// Parts of a URDF: the serial part of a branched robot, the scalar joints of a planar one, joints
/// that yield.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "hg/model/urdf.h"

namespace hg::model {

/// The part of a robot that hangs on link `root` and moves up to link `tip`. Empty: the root of the
/// URDF, and no end. Joints that are not between the two stand still at position 0, so that their
/// links belong to the bodies that carry them; what `root` hangs on is left out.
///
/// Throws SetupError where a name is no link (with the nearest one) or `root` does not carry `tip`.
Urdf serial_part(const Urdf& urdf, const std::string& root, const std::string& tip);

/// The joints "NAME x", "NAME y" (prismatic) and "NAME turn" (continuous, about the normal) that
/// together move like the planar joint NAME; all at its place.
///
/// x is the x axis of the joint's frame projected into the plane, or its y axis where the normal is
/// nearer to x than 45 degrees; y = normal x x. URDF defines <limit> for revolute and prismatic
/// joints only: a planar joint has none.
std::array<UrdfJoint, 3> planar_parts(const UrdfJoint& planar);

/// Puts the joint `name` between the joint `behind` and the link that it carries: of the same kind
/// without limits, about `axis` of that link (none: that of `behind`). The link in between has the
/// least mass that a link may have.
///
/// Throws SetupError where there is no scalar joint `behind` or `name` is taken.
void insert_behind(const std::string& behind, const std::string& name,
                   const std::optional<Eigen::Vector3d>& axis, Urdf& urdf);

}  // namespace hg::model

/// Edits of a URDF: serial part of a branched robot, scalar joints of a planar joint, inserted
/// passive joints.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hg/model/chain_model.h"
#include "hg/model/urdf.h"

namespace hg::model {

/// Subtree of link `root` in which only the joints up to link `tip` move. Empty names: the root of
/// the URDF, and no tip. Joints not between the two are fixed at position 0, so that their links
/// belong to the bodies that carry them; those that follow a joint between the two move with it and
/// are marked as branches. Everything above `root` is left out.
///
/// Throws SetupError if a name is no link (with the nearest one) or `root` does not carry `tip`.
Urdf serial_part(const Urdf& urdf, const std::string& root, const std::string& tip);

/// Splits the planar joint NAME into the joints "NAME x", "NAME y" (prismatic) and "NAME turn"
/// (continuous, about the normal), all at its pose.
///
/// x is the x axis of the joint's frame projected into the plane, or its y axis where the normal is
/// nearer to x than 45 degrees; y = normal x x. URDF defines <limit> for revolute and prismatic
/// joints only: a planar joint has none.
std::array<UrdfJoint, 3> planar_parts(const UrdfJoint& planar);

/// Inserts the joint `name` between the joint `behind` and its child link: same kind, no limits,
/// about `axis` in that link (none: the axis of `behind`). The link in between has the smallest
/// permitted mass.
///
/// Throws SetupError if there is no scalar joint `behind` or `name` is taken.
void insert_behind(const std::string& behind, const std::string& name,
                   const std::optional<Eigen::Vector3d>& axis, Urdf& urdf);

/// The text of a URDF with a <mimic> for each coupling without a curve, for programs that draw it:
/// in place of one that is there already. Joints that the text lacks are left out.
std::string with_mimics(const std::string& urdf, const std::vector<Coupling>& couplings);

/// The text of a URDF with `prefix` before the name of every link, so that two robots can share one
/// tree of frames. A text that is no XML stays as it is.
std::string with_link_prefix(const std::string& urdf, const std::string& prefix);

}  // namespace hg::model

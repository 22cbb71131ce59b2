/// Closed loops of a mechanism: linkages whose two ends meet, such as a four-bar hinge.
///
/// A URDF is a tree, so a loop is cut at one of its joints, and the two links on both sides of the
/// cut get frames that must meet. The joints of the loop then follow one of them: their positions
/// are worked out for its whole range when the model is built, and are curves from then on.
#pragma once

#include <string>
#include <vector>

#include "hg/model/chain_model.h"
#include "hg/model/urdf.h"

namespace hg::model {

/// The couplings that keep a loop closed: one per joint of `follow`, with a curve.
///
/// Begins where all joints are at 0, or the leader is at the end of its range that is nearest to
/// it, and continues from there to both ends of the range. Throws SetupError when a name is none,
/// when the ends do not meet within 0.01 mm somewhere in the range of the leader, and near a dead
/// centre, where a joint would have to move 50 times as fast as the leader.
std::vector<Coupling> close_loop(const Urdf& urdf, const ClosedLoop& loop);

}  // namespace hg::model

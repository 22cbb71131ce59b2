/// Stacked vectors of all joints of a device: gantry first, then manipulator.
#pragma once

#include "hg/core/types.h"

namespace hg {

using VectorPM = VectorUpTo<kMaxGantry + kMaxManipulator>;  ///< Chains p and m, stacked

/// Joins gantry and manipulator vectors: p first, then m.
VectorPM stacked(const VectorP& p, const VectorM& m) noexcept;

}  // namespace hg

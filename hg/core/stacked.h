/// One vector for all joints of a device: the gantry's first, then the manipulator's.
#pragma once

#include "hg/core/types.h"

namespace hg {

using VectorPM = VectorUpTo<kMaxGantry + kMaxManipulator>;  ///< chains p and m, stacked

VectorPM stacked(const VectorP& p, const VectorM& m) noexcept;

}  // namespace hg

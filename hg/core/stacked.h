/// One vector for all joints of a device: the gantry's first, then the manipulator's.
#pragma once

#include "hg/core/types.h"

namespace hg {

using VectorPM = VectorUpTo<kMaxGantry + kMaxManipulator>;  ///< chains p and m, stacked

inline VectorPM stacked(const VectorP& p, const VectorM& m) noexcept {
  VectorPM both(p.size() + m.size());
  both.head(p.size()) = p;
  both.tail(m.size()) = m;
  return both;
}

}  // namespace hg

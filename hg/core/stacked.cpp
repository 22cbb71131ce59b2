#include "hg/core/stacked.h"

namespace hg {

VectorPM stacked(const VectorP& p, const VectorM& m) noexcept {
  VectorPM both(p.size() + m.size());
  // element by element: few values, sizes unknown at compile time
  for (Eigen::Index i = 0; i < p.size(); ++i) both[i] = p[i];
  for (Eigen::Index i = 0; i < m.size(); ++i) both[p.size() + i] = m[i];
  return both;
}

}  // namespace hg

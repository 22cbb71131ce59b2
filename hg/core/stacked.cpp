#include "hg/core/stacked.h"

namespace hg {

VectorPM stacked(const VectorP& p, const VectorM& m) noexcept {
  VectorPM both(p.size() + m.size());
  // number by number: they are few, and their number is known to nobody else
  for (Eigen::Index i = 0; i < p.size(); ++i) both[i] = p[i];
  for (Eigen::Index i = 0; i < m.size(); ++i) both[p.size() + i] = m[i];
  return both;
}

}  // namespace hg

#include "hg/core/stacked.h"

namespace hg {

VectorPM stacked(const VectorP& p, const VectorM& m) noexcept {
  VectorPM both(p.size() + m.size());
  both.head(p.size()) = p;
  both.tail(m.size()) = m;
  return both;
}

}  // namespace hg

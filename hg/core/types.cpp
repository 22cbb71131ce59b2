#include "hg/core/types.h"

namespace hg {

Pose operator*(const Pose& a, const Pose& b) { return {a.p + a.R * b.p, a.R * b.R}; }

Pose inverse(const Pose& a) { return {-(a.R.transpose() * a.p), a.R.transpose()}; }

}  // namespace hg

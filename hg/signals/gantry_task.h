/// Where the rendering law may lead the gantry in one sample.
#pragma once

#include "hg/core/types.h"

namespace hg {

/// One entry per axis, m/s^2 or rad/s^2. All empty: the law leads nothing.
struct GantryTask {
  VectorP ddq_min, ddq_max;  ///< that the drives can follow
  VectorP ddq;               ///< aim
  VectorP unexplained;       ///< of the measured motion, by no command
};

}  // namespace hg

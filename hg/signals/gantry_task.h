/// Task of the rendering law for the gantry in one sample.
#pragma once

#include "hg/core/types.h"

namespace hg {

/// Bounds and aim of the gantry accelerations, one entry per axis, m/s^2 or rad/s^2. All empty: the
/// law does not command the gantry.
struct GantryTask {
  VectorP ddq_min, ddq_max;  ///< Accelerations that the drives can follow
  VectorP ddq;               ///< Desired acceleration
  VectorP unexplained;       ///< Measured acceleration that no command explains
};

}  // namespace hg

/// Task of the rendering law to keep the shapes of the device apart, in one sample.
#pragma once

#include "hg/core/interval.h"
#include "hg/core/stacked.h"
#include "hg/core/types.h"

namespace hg {

/// The smallest distance of the device's shapes on the way on which its joints would brake, and how
/// it changes. Vectors have one entry per joint, gantry first.
struct CollisionTask {
  double distance = kInfinity;  ///< Distance beyond the safe one, m; infinite: nothing is near
  double rate = 0.0;            ///< Its change while the joints keep their speeds, m/s
  VectorPM per_acceleration;    ///< Change of its rate with the joints' accelerations, m s/rad or s
};

}  // namespace hg

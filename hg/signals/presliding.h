/// Dry friction that gives way before it slips: elements in parallel, each a bristle that slips at
/// its share of the torque (Maxwell slip). The same law as that of hg/simulation, without damping.
///
/// Element k = 1..N of friction F with presliding x: stiffness F / (x k), slips at 1/N of the
/// torque. Under F alone it slips after x k / N, so that the last one does after x; load and
/// stiction make all slip later.
#pragma once

#include <algorithm>

#include "hg/core/types.h"
#include "hg/signals/actuator_model.h"

namespace hg {

inline constexpr int kSlipElements = 3;  ///< at most, of one joint

/// Where the bristles of each joint stand, rad (joints x elements).
using BristleFeet = MatrixUpTo<kMaxManipulator, kSlipElements>;

inline bool has_presliding(const ActuatorModel& actuator) noexcept {
  return actuator.presliding > 0.0 && actuator.coulomb_friction > 0.0;
}

/// Of element `k` (from 0), Nm/rad; needs has_presliding().
inline double bristle_stiffness(const ActuatorModel& actuator, int k) noexcept {
  return actuator.coulomb_friction / (actuator.presliding * (k + 1));
}

/// Of all elements of friction that has not slipped, Nm/rad; 0 without presliding.
inline double presliding_stiffness(const ActuatorModel& actuator) noexcept {
  if (!has_presliding(actuator)) return 0.0;
  double sum = 0.0;
  for (int k = 0; k < static_cast<int>(actuator.presliding_elements); ++k) {
    sum += bristle_stiffness(actuator, k);
  }
  return sum;
}

/// Torque against friction of at most `bound` (Nm, > 0) that holds the motor at `theta`; the feet
/// of `joint` follow where its elements slip. Needs has_presliding().
inline double slip(const ActuatorModel& actuator, double theta, double bound, int joint,
                   BristleFeet& feet) noexcept {
  const int elements = static_cast<int>(actuator.presliding_elements);
  const double most = bound / elements;
  double torque = 0.0;
  for (int k = 0; k < elements; ++k) {
    const double stiffness = bristle_stiffness(actuator, k);
    const double bristle = std::clamp(stiffness * (theta - feet(joint, k)), -most, most);
    feet(joint, k) = theta - bristle / stiffness;
    torque += bristle;
  }
  return torque;
}

}  // namespace hg

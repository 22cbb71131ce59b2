/// Presliding friction (Maxwell slip): parallel elements, each an elastic bristle that slips at its
/// share of the torque. Same law as in hg/simulator, without damping.
///
/// Element k = 1..N of friction F with presliding x: stiffness F / (x k), slips at 1/N of the
/// torque. Under F alone it slips after x k / N, the last one after x; load and stiction delay all
/// slips.
#pragma once

#include <algorithm>

#include "hg/core/types.h"
#include "hg/signals/actuator_model.h"

namespace hg {

inline constexpr int kSlipElements = 3;  ///< Largest number of slip elements of a joint

/// Positions of the bristle feet, rad (joints x elements).
using BristleFeet = MatrixUpTo<kMaxManipulator, kSlipElements>;

/// Whether the friction of this actuator has presliding.
inline bool has_presliding(const ActuatorModel& actuator) noexcept {
  return actuator.presliding > 0.0 && actuator.coulomb_friction > 0.0;
}

/// Stiffness of bristle `k` (from 0), Nm/rad; needs has_presliding().
inline double bristle_stiffness(const ActuatorModel& actuator, int k) noexcept {
  return actuator.coulomb_friction / (actuator.presliding * (k + 1));
}

/// Stiffness of all bristles together before any slips, Nm/rad; 0 without presliding.
inline double presliding_stiffness(const ActuatorModel& actuator) noexcept {
  if (!has_presliding(actuator)) return 0.0;
  double sum = 0.0;
  for (int k = 0; k < static_cast<int>(actuator.presliding_elements); ++k) {
    sum += bristle_stiffness(actuator, k);
  }
  return sum;
}

/// Torque, Nm, that holds the motor at `theta` against friction of at most `bound` (Nm, > 0);
/// updates the feet of `joint` where elements slip. Needs has_presliding().
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

/// The user's share of what the force/torque sensor shows: without weight and inertia of the
/// payload, without the sensor's offset, and filtered. Everything in S.
///
/// [C] 2: the acceleration comes from the accelerometer in the sensor. Without it the mass beyond
/// the sensor closes a delayed loop, and light twins shake ([C] 3: below about twice that mass; on
/// stiff arms more, check/light_twin.h). Accelerometer, gyroscope and wrench must have the same
/// delay.
#pragma once

#include "hg/controller/estimation/estimation_config.h"
#include "hg/controller/estimation/tare.h"
#include "hg/core/types.h"
#include "hg/signals/frames.h"
#include "hg/signals/payload.h"

namespace hg::estimation {

struct WrenchState {
  bool is_started = false;
  Eigen::Vector3d omega_S = Eigen::Vector3d::Zero();  ///< Angular velocity in the last sample
  Eigen::Vector3d alpha_S = Eigen::Vector3d::Zero();  ///< Angular acceleration, filtered
  Vector6 w_S = Vector6::Zero();                      ///< Wrench of the user, filtered
  TareState tare;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const WrenchState& state) {
  // is_started: in the flags of EstimationState
  const auto& [is_started, omega_S, alpha_S, w_S, tare] = state;
  hash.mix(omega_S, alpha_S, w_S, tare);
}

/// Delay of the user's wrench after the sensor's sample, for slow changes, s. The sensor's own
/// delay adds to it.
double wrench_delay(const WrenchConfig& config, double dt) noexcept;

/// Wrench without the payload's share of a sensor at rest, resolved in S. `R_B_S` serves devices
/// without accelerometer.
Vector6 without_weight(const WrenchConfig& config, const SensorFrame& sensors,
                       const Eigen::Matrix3d& R_B_S) noexcept;

/// Advances by one period: the user's wrench, state.w_S. A running tare is advanced by advance().
void estimate(const WrenchConfig& config, double dt, const SensorFrame& sensors,
              const Eigen::Matrix3d& R_B_S, WrenchState& state) noexcept;

}  // namespace hg::estimation

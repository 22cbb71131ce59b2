/// State of the control of the joints from cycle to cycle.
#pragma once

#include <cstdint>

#include "hg/controller/tracking/modes.h"
#include "hg/core/types.h"
#include "hg/signals/presliding.h"

namespace hg::tracking {

/// Part of the copyable state of a cycle.
struct ControlState {
  bool is_started = false;
  double latency = 0.0;  ///< Mean latency measured while the drives were off, periods
  int answers = 0;       ///< Samples in that mean, counted up to kAnswersNeeded
  int late = 0;          ///< Samples with old commands minus those without, drives on; >= 0
  Poles poles;           ///< Poles that the latency allows; chosen at the start
  Modes modes;
  VectorM integral;  ///< Integral of q_r - q, rad s
  VectorM friction;  ///< Fed-forward friction over the Coulomb friction of the configuration
  VectorM tau_r, dtau_r, ddtau_r;  ///< Feedforward torque of the links and its derivatives
  Vector6 w_H = Vector6::Zero();   ///< User's wrench in the last sample
  Vector6 dw_H = Vector6::Zero();  ///< Rate of change of the user's wrench, low-passed
  VectorM stiff;                   ///< Torques of stiff modes, low-passed, Nm
  BristleFeet feet;  ///< Bristle feet of the friction fed forward; empty: no joint has presliding
  /// Joint torques that reference and user's wrench do not explain, a moving mean, Nm.
  VectorM unexplained;
  bool is_saturated = false;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const ControlState& state) {
  const auto& [is_started, latency, answers, late, poles, modes, integral, friction, tau_r, dtau_r,
               ddtau_r, w_H, dw_H, stiff, feet, unexplained, is_saturated] = state;
  hash.mix(std::uint64_t{is_started} | std::uint64_t{is_saturated} << 1U, latency,
           static_cast<std::uint64_t>(answers) | static_cast<std::uint64_t>(late) << 32U, poles.w0,
           modes.Q(), integral, friction, tau_r, dtau_r, ddtau_r, unexplained, stiff, w_H, dw_H);
  if (feet.size() > 0) hash.mix(feet);
}

}  // namespace hg::tracking

/// Tare of the force/torque sensor: the mean wrench of a free handle at rest is its zero.
///
/// Refused, and the old tare kept, when the dead-man is closed, when anything moves, or when the
/// wrench varies more than the sensor's noise explains: a hand trembles and drifts. A hand that
/// leans on the handle without a tremble, dead-man open, cannot be told from an offset.
#pragma once

#include "hg/core/types.h"
#include "hg/signals/state.h"

namespace hg::estimation {

/// Set-up data. The noise is that of one sample, at 1 kHz: [HANDBOOK] 1.6.
struct TareConfig {
  bool is_needed = false;        ///< no arming without a tare
  double duration = 0.5;         ///< s, > 0
  double noise_force = 0.08;     ///< rms, N, > 0
  double noise_torque = 2.6e-3;  ///< rms, Nm, > 0
  double deviation_max = 3.0;    ///< of the samples, times the noise; without a hand it is about 1
  double drift_max = 1.0;        ///< between the halves, times the noise; without a hand about 0.1
  double motion_max = 1e-3;      ///< of a joint during the tare, rad or m
};

struct TareState {
  TareStatus status = TareStatus::kNone;
  bool is_valid = false;                 ///< `offset` comes from a tare
  Vector6 offset = Vector6::Zero();      ///< what a free handle shows, in S
  int count = 0;                         ///< samples taken so far, of the tare under way
  Vector6 mean = Vector6::Zero();        ///< of these
  Vector6 square = Vector6::Zero();      ///< sum of their squared deviations from it
  Vector6 first_half = Vector6::Zero();  ///< mean of the first half
  VectorM q_m;                           ///< joints and gantry when it began
  VectorP q_p;
};

/// Begins a new tare.
void begin(TareState& tare) noexcept;

/// The next sample: `w_S` is the wrench without the payload's share. `is_held` is the dead-man.
/// Does nothing unless a tare is under way; changes `offset` only when it ends well.
void advance(const TareConfig& config, double dt, const Vector6& w_S, bool is_held,
             const VectorM& q_m, const VectorP& q_p, TareState& tare) noexcept;

}  // namespace hg::estimation

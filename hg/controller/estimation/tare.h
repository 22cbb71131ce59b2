/// Tare of the force/torque sensor: the mean wrench of a free handle at rest is its zero.
///
/// Refused, and the old tare kept, when the dead-man is closed, when anything moves, or when the
/// wrench varies more than the sensor's noise explains: a hand trembles and drifts. A hand that
/// leans on the handle without a tremble, dead-man open, cannot be distinguished from an offset.
#pragma once

#include <cstdint>

#include "hg/controller/estimation/estimation_config.h"
#include "hg/core/types.h"
#include "hg/signals/state.h"

namespace hg::estimation {

struct TareState {
  TareStatus status = TareStatus::kNone;
  bool is_valid = false;                 ///< `offset` comes from a tare
  Vector6 offset = Vector6::Zero();      ///< Reading of a free handle, in S
  int count = 0;                         ///< Samples taken so far in the running tare
  Vector6 mean = Vector6::Zero();        ///< Mean of these samples
  Vector6 square = Vector6::Zero();      ///< Sum of their squared deviations from the mean
  Vector6 first_half = Vector6::Zero();  ///< Mean of the first half
  VectorM q_m;  ///< Joint positions (and gantry's, below) when the tare began
  VectorP q_p;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const TareState& tare) {
  const auto& [status, is_valid, offset, count, mean, square, first_half, q_m, q_p] = tare;
  hash.mix(static_cast<std::uint64_t>(status) | std::uint64_t{is_valid} << 8U, count, offset, mean,
           square, first_half, q_m, q_p);
}

/// Begins a new tare.
void begin(TareState& tare) noexcept;

/// Processes the next sample: `w_S` is the wrench without the payload's share. `is_held`: the
/// dead-man is closed. No effect unless a tare is running; changes `offset` only when it succeeds.
void advance(const TareConfig& config, double dt, const Vector6& w_S, bool is_held,
             const VectorM& q_m, const VectorP& q_p, TareState& tare) noexcept;

}  // namespace hg::estimation

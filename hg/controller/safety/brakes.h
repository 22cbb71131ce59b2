/// Monitors axes whose drives are off: a closed brake must hold its axis where it came to rest.
///
/// Uses motor and link encoders only, so that a wrong value of another sensor cannot hide a falling
/// axis. Inactive until the drives had power for the first time: before that the device may be
/// moved from outside. No allocation, noexcept.
#pragma once

#include <cstdint>

#include "hg/controller/safety/monitor.h"
#include "hg/signals/fault.h"
#include "hg/signals/frames.h"

namespace hg::safety {

/// Positions of gantry axes, links and motors, in this order; rad or m.
using BrakedAxes = VectorUpTo<kMaxGantry + 2 * kMaxManipulator>;

/// Part of the copyable state of a cycle.
struct BrakeState {
  bool was_powered = false;
  /// Samples since power-off, counted up to those of a stop; 0 = power is on.
  std::uint32_t samples_off = 0;
  std::uint16_t broken = 0;  ///< Consecutive samples with an axis beyond its allowed motion
  BrakedAxes last;           ///< Positions of the last sample, rad or m
  BrakedAxes from;           ///< Positions from which motion is measured, rad or m
  BrakedAxes may_move;       ///< Allowed distance of each axis from `from`, rad or m
  Fault slip;                ///< Detected slip, kBrakesSlip; latched for the whole run
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const BrakeState& state) {
  const auto& [was_powered, samples_off, broken, last, from, may_move, slip] = state;
  hash.mix(std::uint64_t{samples_off} | std::uint64_t{was_powered} << 32U |
               static_cast<std::uint64_t>(slip.code) << 40U,
           broken, last, from, may_move);
}

/// Checks the brakes; call once per cycle, even where the sample is otherwise unusable. An axis may
/// move by its slip tolerance. For the duration of a stop after power-off, an axis that was still
/// moving may also move by (speed / rated speed) of its stopping distance. Returns the slip, or
/// kNone; its index is the joint, gantry axes follow after the joints.
Fault watch_brakes(const MonitorConfig& config, const DeviceModel& device,
                   const SensorFrame& sensors, bool is_powered, BrakeState& state) noexcept;

}  // namespace hg::safety

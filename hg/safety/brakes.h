/// Watches axes whose drives are off: closed brakes hold each where they have found it at rest.
///
/// By the bare encoders of motors and links, so that no other sensor that is wrong hides a fall.
/// Before there was power for the first time others may move the device. No allocation, noexcept.
#pragma once

#include <cstdint>

#include "hg/safety/monitor.h"
#include "hg/signals/fault.h"
#include "hg/signals/frames.h"

namespace hg::safety {

/// Axes of the gantry, links, motors.
using BrakedAxes = VectorUpTo<kMaxGantry + 2 * kMaxManipulator>;

/// Part of the copyable state of a cycle.
struct BrakeState {
  bool was_powered = false;
  std::uint32_t samples_off = 0;  ///< since the power went, up to those of a stop; 0: it is on
  std::uint16_t broken = 0;       ///< samples in a row with an axis that has moved too far
  BrakedAxes last;                ///< positions of the last sample
  BrakedAxes from;                ///< where the axes stood, rad or m
  BrakedAxes may_move;            ///< how far they may get from there
  Fault slip;                     ///< kBrakesSlip, kept for the whole run
};

/// Once per cycle, whatever else the sample is worth. An axis may move by its slip; one that still
/// moved when the power went, for the time of a stop, also by that share of its stopping distance
/// which its speed is of its rating. Returns the slip: index of the joint, those of the gantry
/// behind them.
Fault watch_brakes(const MonitorConfig& config, const SensorFrame& sensors, bool is_powered,
                   BrakeState& state) noexcept;

}  // namespace hg::safety

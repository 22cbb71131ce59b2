/// How a controlled stop brakes, and how long and far that takes from full speed.
#pragma once

#include <algorithm>
#include <cmath>

#include "hg/signals/drive_model.h"

namespace hg::safety {

inline constexpr double kBrakingRate = 20.0;  ///< 1/s, of the law: a slow motion halves in 35 ms
inline constexpr double kRampOut = 0.1;       ///< s in which forces make room for braking
inline constexpr double kStandstill = 1e-3;   ///< rad/s and m/s: below it a stop is over

/// What a stop takes: s, and rad or m.
struct StoppingNeed {
  double time = 0.0, distance = 0.0;
};

/// What of a stopping distance is left to the axis; then the monitor closes the brakes.
inline constexpr double kUntilBrakes = 0.9;

/// Of a joint at speed `v` with the acceleration `ddq` of its rating; both finite.
inline StoppingNeed stopping_need(double v, double ddq) noexcept {
  const double slow = std::min(v, ddq / kBrakingRate);  // from here on it decays with the rate
  return {.time = kRampOut + (v - slow) / ddq +
                  std::max(0.0, std::log(slow / kStandstill)) / kBrakingRate,
          .distance = kRampOut * v + 0.5 * (v * v - slow * slow) / ddq + slow / kBrakingRate};
}

/// Of an axis of the gantry at full speed, commanded to stand still.
inline StoppingNeed stopping_need(const DriveModel& drive) noexcept {
  const double v = drive.dq_max;
  const double slow = std::min(v, drive.ddq_max * drive.lag);
  return {.time = drive.dead_time + (v - slow) / drive.ddq_max +
                  drive.lag * std::max(0.0, std::log(slow / kStandstill)),
          .distance =
              v * drive.dead_time + 0.5 * (v * v - slow * slow) / drive.ddq_max + slow * drive.lag};
}

}  // namespace hg::safety

/// Braking of a controlled stop, and the time and distance it takes from full speed.
#pragma once

#include <algorithm>
#include <cmath>

#include "hg/signals/drive_model.h"

namespace hg::safety {

/// Braking rate of the law, 1/s: a slow motion halves in 35 ms.
inline constexpr double kBrakingRate = 20.0;
inline constexpr double kRampOut = 0.1;      ///< Time to ramp out forces in favour of braking, s
inline constexpr double kStandstill = 1e-3;  ///< Speed below which a stop is over, rad/s and m/s

/// Largest time by which drives that follow positions are behind their reference, s [A].
inline constexpr double kDriveLag = 0.04;

/// Time by which a joint of the device may be behind its reference, s.
inline double drive_lag(bool follows_positions) noexcept {
  return follows_positions ? kDriveLag : 0.0;
}

/// Time and distance of a stop: s, and rad or m.
struct StoppingNeed {
  double time = 0.0, distance = 0.0;
};

/// Share of a stopping distance at which the monitor closes the brakes.
inline constexpr double kUntilBrakes = 0.9;

/// Stopping time and distance of a joint at speed `v` with its rated acceleration `ddq`, both
/// finite, that is `lag` s behind its reference.
inline StoppingNeed stopping_need(double v, double ddq, double lag) noexcept {
  const double slow = std::min(v, ddq / kBrakingRate);  // from here on it decays with the rate
  return {
      .time = kRampOut + lag + (v - slow) / ddq +
              std::max(0.0, std::log(slow / kStandstill)) / kBrakingRate,
      .distance = (kRampOut + lag) * v + 0.5 * (v * v - slow * slow) / ddq + slow / kBrakingRate};
}

/// Stopping time and distance of a gantry axis at full speed, commanded to stand still.
inline StoppingNeed stopping_need(const DriveModel& drive) noexcept {
  const double v = drive.dq_max;
  const double slow = std::min(v, drive.ddq_max * drive.lag);
  return {.time = drive.dead_time + (v - slow) / drive.ddq_max +
                  drive.lag * std::max(0.0, std::log(slow / kStandstill)),
          .distance =
              v * drive.dead_time + 0.5 * (v * v - slow * slow) / drive.ddq_max + slow * drive.lag};
}

}  // namespace hg::safety

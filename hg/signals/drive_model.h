/// Model of how a velocity-controlled gantry axis follows its command. Shared by the simulation and
/// the observer of the gantry.
#pragma once

#include <algorithm>
#include <array>

namespace hg {

/// Response of a velocity-controlled drive, [HANDBOOK] 1.5. Set-up data.
struct DriveModel {
  double dead_time = 4e-3;  ///< Dead time, s, >= 0
  double lag = 40e-3;       ///< First-order time constant, s, > 0
  double dq_max = 1.5;      ///< Largest speed, m/s (rad/s for a revolute axis)
  double ddq_max = 2.5;     ///< Largest acceleration, m/s^2 (rad/s^2)
};

/// Acceleration of the drive at speed `dq` for the command `dq_cmd`, dead time already applied.
inline double drive_acceleration(const DriveModel& drive, double dq, double dq_cmd) noexcept {
  const double dq_limited = std::clamp(dq_cmd, -drive.dq_max, drive.dq_max);
  return std::clamp((dq_limited - dq) / drive.lag, -drive.ddq_max, drive.ddq_max);
}

/// Dead time of a drive: delays commands by whole periods.
class CommandDelay {
 public:
  static constexpr int kMaxPeriods = 255;

  /// Stores the command of this period and returns the one from `periods` (0..kMaxPeriods) periods
  /// ago; 0 before the first.
  double shift(double command, int periods) noexcept {
    values_[next_] = command;
    const int delayed = (next_ - periods + kCapacity) % kCapacity;
    next_ = (next_ + 1) % kCapacity;
    return values_[delayed];
  }

 private:
  static constexpr int kCapacity = kMaxPeriods + 1;
  std::array<double, kCapacity> values_{};
  int next_ = 0;
};

}  // namespace hg

/// First and last in the line: refuses sensor values that cannot be used, and commands that must
/// not leave. Not a certified safety function.
///
/// No allocation, noexcept after set-up.
#pragma once

#include <vector>

#include "hg/core/interval.h"
#include "hg/signals/state.h"

namespace hg::safety {

/// Set-up data.
struct MonitorConfig {
  double force_max = 150.0;                ///< [HANDBOOK] 6.2, N
  double torque_max = 14.0;                ///< Nm; the sensor ends at 15
  bool has_dead_man = true;                ///< false: the handle counts as held all the time
  bool has_imu = true;                     ///< false: nobody looks at what its fields hold
  double position_tolerance = 0.03;        ///< beyond the limit of a revolute joint, rad
  double slide_tolerance = 0.03;           ///< beyond the limit of a prismatic joint, m
  double cartesian_tolerance = 0.03;       ///< outside a Cartesian limit, m
  double speed_tolerance = 1.1;            ///< times the rating
  double tracking_tolerance = 0.08;        ///< reference minus measured joint, rad
  double slide_tracking_tolerance = 0.02;  ///< the same of a prismatic joint, m
  double sync_tolerance = 0.02;            ///< between handle and twin, m
  double gantry_speed_max = 1.5;           ///< m/s or rad/s
  std::vector<Interval> joint_range;       ///< of the manipulator joints
  std::vector<bool> is_slide;              ///< manipulator joints that are prismatic; empty = none
  double stop_time = 1.0;                  ///< that a controlled stop may take, s
  int first_cartesian = 0;  ///< Cartesian limits in the catalogue: first and one past the last
  int end_cartesian = 0;
  std::vector<double> joint_speed_max;  ///< rad/s or m/s
};

/// Whether somebody holds the handle, as far as the device can tell.
inline bool is_held(const MonitorConfig& config, const SensorFrame& sensors) noexcept {
  return sensors.dead_man || !config.has_dead_man;
}

/// Whether every measured value is a number: others must not reach the estimation.
bool is_finite(const MonitorConfig& config, const SensorFrame& sensors) noexcept;

/// The first thing wrong with what was measured, or kNone.
Fault check_sensors(const MonitorConfig& config, const SensorFrame& sensors,
                    std::uint64_t expected_sequence) noexcept;

/// Whether the rendering gave a solution that may be integrated; the fault, or kNone.
Fault check_solution(const CycleRecord& record) noexcept;

/// The first thing wrong with the reference or the state behind it, or kNone.
Fault check_reference(const MonitorConfig& config, const CycleRecord& record) noexcept;

/// Last hand on the command: non-finite values become safe ones and disable the drives, speeds are
/// clamped. Leaves a command that is fine untouched, bit for bit. Returns kCommandNotFinite, with
/// the index of the component, when it had to disable.
Fault sanitise(const MonitorConfig& config, CommandFrame& command) noexcept;

}  // namespace hg::safety

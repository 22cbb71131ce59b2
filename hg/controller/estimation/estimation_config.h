/// Set-up data of the estimation.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hg/core/types.h"
#include "hg/signals/payload.h"
#include "hg/signals/state.h"

namespace hg::estimation {

/// Set-up data. The noise is that of one sample, at 1 kHz: [HANDBOOK] 1.6.
struct TareConfig {
  bool is_needed = false;        ///< Arming requires a tare
  double duration = 0.5;         ///< Duration, s, > 0
  double noise_force = 0.08;     ///< Noise of the force, rms, N, > 0
  double noise_torque = 2.6e-3;  ///< Noise of the torque, rms, Nm, > 0
  /// Largest deviation of the samples, times the noise; without a hand it is about 1.
  double deviation_max = 3.0;
  /// Largest change between the halves, times the noise; without a hand about 0.1.
  double drift_max = 1.0;
  double motion_max = 1e-3;  ///< Largest motion of a joint during the tare, rad or m
};

/// Set-up data. Low-passes are of first order; 0 = off.
struct WrenchConfig {
  Payload payload;      ///< Payload beyond the sensor
  bool has_imu = true;  ///< accelerometer and gyroscope in S; false: weight by the pose, no inertia
  double alpha_low_pass_Hz = 60.0;  ///< Low-pass of the gyroscope's differences; [C] 2
  double low_pass_Hz = 0.0;         ///< Low-pass of the whole wrench; 50 for a noisy sensor, [C] 2
  TareConfig tare;
};

struct UnitCalibration;
using UnitCalibrations = std::array<UnitCalibration, kMaxInertialUnits>;

/// Set-up data.
struct InertialUnitsConfig {
  std::vector<int> frames;  ///< Frames of links with a unit, root to tip; empty = no units
  double delay = 1e-3;      ///< Delay from motion to reading, s; rounded to periods, at least one
  /// true: the control uses the units; false: their results are only reported.
  bool feeds_back = false;
  /// Mounting of the units known from an earlier run of the same device; null = it is learnt.
  std::shared_ptr<const UnitCalibrations> known;
};

/// Set-up data.
struct EstimationConfig {
  double observer_pole_Hz = 8.0;     ///< Pole of the gantry observer, see gantry_observer.h
  double link_pole_Hz = 100.0;       ///< Pole of the link side; [C] 2: 60-160 equal, 40 marginal
  double motor_low_pass_Hz = 200.0;  ///< Low-pass of the motor side's speed
  WrenchConfig wrench;
  InertialUnitsConfig units;  ///< Inertial units on links
};

}  // namespace hg::estimation

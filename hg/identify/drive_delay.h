/// The delay of drives that follow positions: from a command to the position that it asks for.
///
/// Model, with the command interpolated between its samples:
///   q(t) = r(t - d) + (L^2 / 2) r''(t - d) + sum of f_i sgn r'(t - d - a_i) + o
/// d is the whole delay, transport and lag. Of a delay and a lag in series only L, the time
/// constant of the lag, shows beside it: to second order exp(-s (d - L)) / (1 + L s) = exp(-s d) (1
/// + s^2 L^2 / 2). f (for some ages a) and o are what friction and load leave of the error.
/// Gauss-Newton in d. Deviations: jackknife over blocks of 1 s.
///
/// SI units.
#pragma once

#include <string>
#include <vector>

#include "hg/identify/figure.h"
#include "hg/identify/joint_recording.h"

namespace hg::identify {

struct DriveDelay {
  Figure delay;           ///< d, s
  Figure lag;             ///< L, s; not found: none was seen, and `deviation` is the largest hidden
  double speed = 0.0;     ///< rms of the commanded speed, rad/s
  double residual = 0.0;  ///< rms of the unexplained position, rad
  std::vector<std::string> missing;  ///< motions needed for the parameters not found
};

/// Identifies the delay of joint `joint` of the manipulator.
DriveDelay identify_delay(const std::vector<JointMotion>& parts, int joint, double period_s);

/// The delay of all joints together, weighted by their deviations; the deviation is at least the
/// scatter of the joints. Not found where it is of no joint.
Figure common_delay(const std::vector<DriveDelay>& joints);

}  // namespace hg::identify

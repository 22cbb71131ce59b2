/// Identifies the friction of a series elastic joint from a recording of its motion.
///
/// Model, everything at the output of the gear:
///   tau_motor - tau_J - Jm theta'' = dry + B theta' + o + g tau_J + j theta''
/// dry: elements of Maxwell slip (hg/signals/presliding.h) with a damper each, of together at most
///   (F + mu |tau_J|) (1 + (s - 1) exp(-(theta' / v_s)^2)).
/// o, g and j are what sensors and rotor inertia are wrong by, and not reported. Both sides go
/// through the same smoothing, so that it does not bias what is found. Least squares with Huber's
/// weights: scan over presliding and stiction, then Levenberg and Marquardt. Deviations: jackknife
/// over blocks of 1 s, one Gauss-Newton step each, so that correlated errors count in full.
///
/// SI units; for a prismatic joint read N for Nm and m for rad.
#pragma once

#include <string>
#include <vector>

#include "hg/signals/actuator_model.h"

namespace hg::identification {

/// What one joint did while its drive was on, sample by sample.
struct FrictionTrace {
  double period_s = 1e-3;
  std::vector<double> theta;      ///< motor, unwrapped, rad
  std::vector<double> tau_motor;  ///< of the motor, Nm
  std::vector<double> tau_J;      ///< of the spring, Nm
  std::vector<std::size_t> cuts;  ///< samples that do not follow the one before; the first is one
};

/// A number and its standard deviation.
struct FrictionFigure {
  double value = 0.0;
  double deviation = 0.0;
  bool is_found = false;  ///< false: the motion does not show it, `value` is what was believed
};

struct FrictionEstimate {
  FrictionFigure coulomb;         ///< F, Nm
  FrictionFigure load;            ///< mu
  FrictionFigure viscous;         ///< B, Nms/rad
  FrictionFigure stiction;        ///< s
  FrictionFigure stribeck_speed;  ///< v_s, rad/s
  FrictionFigure presliding;      ///< way until the last element slips, rad
  int presliding_elements = 0;    ///< with which it fits best; 0 = no presliding was found
  double residual = 0.0;          ///< rms, Nm
  double forward_s = 0.0, backward_s = 0.0;  ///< for which the joint slid in each direction
  double speed = 0.0;                        ///< that 99 % of the samples stay below, rad/s
  int reversals = 0;                         ///< after a way of kReversalWay and more
  std::vector<std::string> missing;          ///< which motion is needed for what was not found
};

inline constexpr double kSlidingSpeed = 0.005;  ///< from which on a joint counts as sliding, rad/s
inline constexpr double kSlidingTime = 1.0;     ///< s that it must slide in each direction
inline constexpr double kReversalWay = 1e-3;    ///< rad
inline constexpr int kFewestReversals = 6;      ///< that show presliding
inline constexpr int kFewestBlocks = 10;        ///< of 1 s each, for deviations

/// `believed` gives the rotor inertia, and what is kept where the motion does not show it.
FrictionEstimate identify_friction(const FrictionTrace& trace, const ActuatorModel& believed);

}  // namespace hg::identification

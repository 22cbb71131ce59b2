/// Identifies the friction of a series elastic joint from a recording of its motion.
///
/// Model, everything at the output of the gear:
///   tau_motor - tau_J - Jm theta'' = dry + B theta' + o + g tau_J + j theta''
/// dry: elements of Maxwell slip (hg/signals/presliding.h) with a damper each, of together at most
///   (F + mu |tau_J|) (1 + (s - 1) exp(-(theta' / v_s)^2)).
/// o, g and j are errors of sensors and rotor inertia, and not reported. Both sides pass the same
/// smoothing, so that it does not bias the result. Least squares with Huber's weights: scan over
/// presliding and stiction, then Levenberg and Marquardt. Deviations: jackknife over blocks of 1 s,
/// one Gauss-Newton step each, so that correlated errors count in full.
///
/// SI units; for a prismatic joint read N for Nm and m for rad.
#pragma once

#include <string>
#include <vector>

#include "hg/identify/figure.h"
#include "hg/signals/actuator_model.h"

namespace hg::identify {

/// Motion and torques of one joint while its drive was on, sample by sample.
struct FrictionTrace {
  double period_s = 1e-3;
  std::vector<double> theta;      ///< motor position, unwrapped, rad
  std::vector<double> tau_motor;  ///< motor torque, Nm
  std::vector<double> tau_J;      ///< spring torque, Nm
  /// Indices of samples that do not follow the one before; includes the first sample
  std::vector<std::size_t> cuts;
};

struct FrictionEstimate {
  Figure coulomb;         ///< F, Nm
  Figure load;            ///< mu
  Figure viscous;         ///< B, Nms/rad
  Figure stiction;        ///< s
  Figure stribeck_speed;  ///< v_s, rad/s
  Figure presliding;      ///< displacement until the last element slips, rad
  /// Number of elements with the best fit; 0 = no presliding was found
  int presliding_elements = 0;
  double residual = 0.0;                     ///< rms of the residual, Nm
  double forward_s = 0.0, backward_s = 0.0;  ///< sliding time in each direction
  double speed = 0.0;                        ///< 99th percentile of the speed, rad/s
  int reversals = 0;  ///< number of reversals after a displacement of kReversalWay and more
  std::vector<std::string> missing;  ///< motions needed for the parameters not found
};

/// Speed from which a joint counts as sliding, rad/s
inline constexpr double kSlidingSpeed = 0.005;
inline constexpr double kSlidingTime = 1.0;   ///< sliding time needed in each direction, s
inline constexpr double kReversalWay = 1e-3;  ///< displacement after which a reversal counts, rad
inline constexpr int kFewestReversals = 6;    ///< fewest reversals that show presliding
inline constexpr int kFewestBlocks = 10;      ///< fewest blocks of 1 s each, for deviations

/// Identifies friction; `nominal` gives the rotor inertia, and the values kept where the motion
/// does not show them.
FrictionEstimate identify_friction(const FrictionTrace& trace, const ActuatorModel& nominal);

}  // namespace hg::identify

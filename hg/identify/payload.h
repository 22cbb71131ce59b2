/// Identifies the payload beyond the force/torque sensor from poses at rest: mass, centre of mass,
/// and the sensor's offset. [HANDBOOK] 4.5: six poses and more.
///
/// Model at rest, in S: f = -m a + f_0, n = -m c x a + n_0, with a = acceleration minus gravity;
/// two linear least-squares problems, (m, f_0) and (m c, n_0). The inertia is not observable at
/// rest. Errors of gain and cross-talk are not modelled: they remain as residuals.
#pragma once

#include <span>
#include <string>

#include "hg/core/types.h"

namespace hg::identify {

/// Mean values over a pose at rest, with a free handle.
struct StaticPose {
  Eigen::Vector3d a_S = Eigen::Vector3d::Zero();  ///< acceleration minus gravity in S
  Vector6 w_S = Vector6::Zero();                  ///< wrench at the sensor, in S
};

/// Estimated payload. Deviations are one standard deviation, from the residuals; infinite where not
/// observable.
struct PayloadEstimate {
  double mass = 0.0;                              ///< kg
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< centre of mass in S, m
  Vector6 offset = Vector6::Zero();               ///< offset of the sensor
  double mass_deviation = 0.0;                    ///< kg
  double com_deviation = 0.0;                     ///< deviation in the worst direction, m
  double force_residual = 0.0;                    ///< rms residual of a component, N
  double torque_residual = 0.0;                   ///< rms residual of a component, Nm
  /// Ratio of worst to best determined direction of the centre of mass; 1 = all alike, large = some
  /// poses are missing.
  double condition = 0.0;
  std::string missing;  ///< poses needed for a usable result; empty = it is usable
};

/// Fewest poses of a usable result; its standard deviations must be within the accuracies below.
inline constexpr int kFewestPoses = 6;
inline constexpr double kMassAccuracy = 0.01;  ///< largest relative deviation of the mass
inline constexpr double kComAccuracy = 2e-3;   ///< m

/// Identifies the payload from any number of poses, in any order.
PayloadEstimate identify_payload(std::span<const StaticPose> poses);

}  // namespace hg::identify

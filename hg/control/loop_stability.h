/// Whether the closed torque loop is stable: sampling, latency, current lag, filters, feedback.
///
/// Linear: without Coulomb friction (which only helps), the user, and torque limits. Errors of one
/// period are answered, so that slow or separate parts are not in it: the integral, what is learnt
/// of the friction, and the filter of the feedforward (stable by itself, see control::check()).
/// Set-up only.
#pragma once

#include <vector>

#include "hg/control/joint_control.h"

namespace hg::control {

/// Filters of the estimation that stand in the loop.
struct LoopFilters {
  double link_pole_Hz = 100.0;
  double motor_low_pass_Hz = 200.0;  ///< 0 = none
};

/// An arm with its controller, as far as they stand in the loop.
struct Loop {
  Config config;
  LoopFilters filters;
  model::Chain chain;  ///< gantry joints first
  int n_p = 0, n_m = 0, handle = 0;
};

/// What is really the case, whatever the controller believes.
struct Reality {
  std::vector<ActuatorModel> actuators;
  TorqueLoop loop;
  double link_mass = 1.0;  ///< masses and inertias of the links over those that are believed
  VectorM bristles;        ///< stiffness of friction that has not slipped, Nm/rad; empty = none
};

/// Largest modulus of the eigenvalues of one period at rest in posture `q` (gantry first), with the
/// gains for `latency` (s): below 1 errors die out. The feedback is found by asking JointControl.
double spectral_radius(const Loop& loop, const Eigen::VectorXd& q, double latency);
/// The same where the controller is wrong: it believes its configuration and `latency`.
double spectral_radius(const Loop& loop, const Eigen::VectorXd& q, double latency,
                       const Reality& reality);

/// The longest latency in whole periods, from `least` to `most`, up to which the loop is stable in
/// all `postures`; least - 1 = not even at the least.
int longest_stable_latency(const Loop& loop, const std::vector<Eigen::VectorXd>& postures, int most,
                           int least = 1);

}  // namespace hg::control

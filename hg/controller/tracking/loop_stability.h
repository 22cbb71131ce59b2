/// Whether the closed torque loop is stable: sampling, latency, current lag, filters, feedback.
///
/// Linear: without Coulomb friction (which only helps), the user, and torque limits. Only the
/// response to errors of one period is modelled, so that slow or separate parts are excluded: the
/// integral, the learning of friction, and the filter of the feedforward (stable on its own, see
/// tracking::check_control_config()). Set-up only.
#pragma once

#include <vector>

#include "hg/controller/tracking/joint_control.h"
#include "hg/model/chain_model.h"

namespace hg::tracking {

/// Filters of the estimation that are part of the loop.
struct LoopFilters {
  double link_pole_Hz = 100.0;
  double motor_low_pass_Hz = 200.0;  ///< Low-pass of the motor speed; 0 = none
};

/// Arm and controller, as far as they are part of the loop.
struct Loop {
  ControlConfig config;
  LoopFilters filters;
  DeviceModel device;
};

/// True plant, independent of the model that the controller uses.
struct TruePlant {
  std::vector<ActuatorModel> actuators;
  TorqueLoop loop;
  /// Masses and inertias of the links over those of the controller's model.
  double link_mass = 1.0;
  VectorM bristles;  ///< Stiffness of friction that has not slipped, Nm/rad; empty = none
};

/// Largest modulus of the eigenvalues of one period at rest in posture `q` (gantry first), with the
/// gains for `latency` (s): below 1 errors decay. The feedback is obtained by evaluating
/// JointControl.
double spectral_radius(const Loop& loop, const Eigen::VectorXd& q, double latency);
/// Spectral radius where the controller's model is wrong: it uses its configuration and `latency`,
/// the plant is `plant`.
double spectral_radius(const Loop& loop, const Eigen::VectorXd& q, double latency,
                       const TruePlant& plant);

/// Longest latency in whole periods, from `least` to `most`, up to which the loop is stable in all
/// `postures`; least - 1 = not even at the least.
int longest_stable_latency(const Loop& loop, const std::vector<Eigen::VectorXd>& postures, int most,
                           int least = 1);

}  // namespace hg::tracking

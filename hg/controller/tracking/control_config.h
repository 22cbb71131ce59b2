/// Set-up data of the control of the joints.
#pragma once

#include "hg/controller/tracking/modes.h"
#include "hg/core/interval.h"
#include "hg/signals/actuator_model.h"

namespace hg::tracking {

enum class Method {
  kDrives,   ///< the drives follow the reference on their own
  kModal,    ///< full-state feedback in the modes of the arm
  kMotorPd,  ///< stiffness and damping on the motor side of each joint alone
};

/// Set-up data.
struct ControlConfig {
  Method method = Method::kDrives;
  TorqueLoop loop;  ///< Torque loop with the expected latency; the true latency is measured
  /// Largest measured latency with which the loop is known to be stable, s.
  double latency_max = kInfinity;
  double integral_rate = 2.0;    ///< kModal: decay rate of the link error, 1/s
  double integral_max = 3.5e-4;  ///< Largest integral of the link error, rad s: no wind-up beyond
  Poles poles;                   ///< kModal: poles without latency
  /// Low-pass of derivatives of feedforward torques; see check_control_config()
  double flatness_Hz = 40.0;
  double wrench_lead = 0.0;        ///< kModal: lead of the user's wrench in the feedforward, s
  double lead_low_pass_Hz = 65.0;  ///< Low-pass of the wrench's rate of change for that lead
  double stiff_low_pass_Hz = 0.0;  ///< kModal: low-pass of the feedforward to stiff modes; 0 = none
  double error_max = kInfinity;    ///< Largest lead of the reference over the joint, rad or m
  double friction_share = 0.8;     ///< Share of the Coulomb friction that is fed forward, 0..1
  /// Speed over which the fed-forward friction changes its sign, without presliding, rad/s.
  double friction_speed = 0.01;
  double friction_learning = 1.0;  ///< kModal: rate at which the true friction is learnt, 1/s
};

/// Largest flatness_Hz of a loop with `rate_Hz`; beyond it the feedforward filter is unstable.
double largest_flatness_Hz(double rate_Hz) noexcept;

/// Largest expected latency; stability with more is not checked.
inline constexpr int kMostLatency = 64;  // periods

/// Throws SetupError where the period of `rate_Hz` is too long for flatness_Hz or too short for the
/// latency.
void check_control_config(const ControlConfig& config, double rate_Hz);

}  // namespace hg::tracking

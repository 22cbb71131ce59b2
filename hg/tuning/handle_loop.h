/// The whole loop around the handle as a linear system: the person's hand, series elastic arm,
/// sensors, estimation, a free body as the twin, and the torque control.
///
/// Unlike control/loop_stability.h, which has feedback alone, the hand's push goes through the
/// force/torque sensor into twin and feedforward here: what a person feels, which noise reaches
/// the handle, and which hand makes it swing, follow from one matrix. Small motions about rest in
/// one posture, without friction, torque limits, tremor, gantry, and payload (whose inertia the
/// sensor's own accelerometer takes off). The controller is asked, not modelled: JointControl
/// answers every unit of its inputs and of its own state. SI units; set-up only.
#pragma once

#include <Eigen/Core>

#include "hg/control/loop_stability.h"
#include "hg/user/hand.h"

namespace hg::tuning {

/// A free body that is rendered, its centre of mass in the handle.
struct Body {
  double mass = 6.0;             ///< kg
  double damping = 4.0;          ///< Ns/m
  double inertia = 0.08;         ///< about all axes, kg m^2
  double angular_damping = 0.1;  ///< Nms/rad
};

/// The force/torque sensor and what estimation makes of it.
struct WrenchPath {
  double average_s = 1e-3;     ///< mean that the sensor takes
  double delay_s = 1.5e-3;     ///< after that
  double low_pass_Hz = 100.0;  ///< of the estimation; 0 = none
};

/// Standard deviations of white noise, of one sample unless it says otherwise.
struct Noise {
  double force = 0.0;     ///< of the wrench, N/sqrt(Hz), with the accelerometer's on the payload
  double torque = 0.0;    ///< likewise, Nm/sqrt(Hz)
  Eigen::VectorXd joint;  ///< of the joint torque sensors, Nm
  double link_encoder = 0.0;   ///< rad
  double motor_encoder = 0.0;  ///< rad at the joint
};

/// What does not change from posture to posture.
struct Device {
  control::Loop loop;
  WrenchPath wrench;
};

/// What one sample does to the next: x' = A x + B_push f + B_motor d +
/// B_noise e, y = C x. Positions are
/// deviations from rest.
struct HandleLoop {
  Eigen::MatrixXd A;
  /// Of a force on the hand's mass along the axes of H (3 columns), N.
  Eigen::MatrixXd B_push;
  /// Of torques on the motors (n columns), Nm.
  Eigen::MatrixXd B_motor;
  /// Of unit deviations of the noise: force, torque (6), joint torques, link and motor encoders.
  Eigen::MatrixXd B_noise;
  /// Along the axes of H: velocity of the handle, force of the hand on it, position of the handle,
  /// position of the twin (3 rows each).
  Eigen::MatrixXd C;
  double period_s = 1e-3;
};

/// In posture `q` (gantry first) with `hand` on the handle; `reality` is what the controller does
/// not know.
HandleLoop linearise(const Device& device, const control::Reality& reality, const Body& body,
                     const user::HandImpedance& hand, const Noise& noise, const Eigen::VectorXd& q);

/// Solves (z 1 - A) x = b and its transpose for many z: A is brought to Hessenberg form once.
class Resolvent {
 public:
  explicit Resolvent(const Eigen::MatrixXd& A);

  /// Of the last `at(z)`.
  void at(std::complex<double> z);
  Eigen::MatrixXcd solve(const Eigen::MatrixXd& B) const;             ///< (z 1 - A)^-1 B
  Eigen::MatrixXcd solve_transposed(const Eigen::MatrixXd& C) const;  ///< C (z 1 - A)^-1

 private:
  Eigen::MatrixXd H_, Q_;           // A = Q H Q^T
  Eigen::MatrixXcd U_;              // of the rows in the order of the pivots
  Eigen::VectorXcd multipliers_;    // one per step of the elimination
  std::vector<bool> is_exchanged_;  // rows i and i + 1 in step i
};

}  // namespace hg::tuning

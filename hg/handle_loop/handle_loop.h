/// The whole loop around the handle as a linear system: the person's hand, series elastic arm,
/// sensors, estimation, a free body as the twin, and the torque control.
///
/// Unlike tracking/loop_stability.h, which has feedback alone, the hand's force passes through the
/// force/torque sensor into twin and feedforward here: felt impedance, noise at the handle, and
/// stability with a given hand follow from one matrix. Small motions about rest in one posture,
/// without friction, torque limits, tremor and gantry. The controller is not modelled but
/// evaluated: JointControl is called with unit values of its inputs and of its state. SI units;
/// set-up only.
#pragma once

#include <Eigen/Core>

#include "hg/controller/tracking/loop_stability.h"
#include "hg/signals/payload.h"
#include "hg/simulator/person/hand.h"

namespace hg::handle_loop {

/// A free body that is rendered, its centre of mass in the handle.
struct Body {
  double mass = 6.0;             ///< kg
  double damping = 4.0;          ///< Ns/m
  double inertia = 0.08;         ///< inertia about all axes, kg m^2
  double angular_damping = 0.1;  ///< Nms/rad
};

/// Path of the wrench through the force/torque sensor and the estimation.
struct WrenchPath {
  double average_s = 1e-3;     ///< averaging time of the sensor
  double delay_s = 1.5e-3;     ///< delay after the averaging
  double low_pass_Hz = 100.0;  ///< low-pass of the estimation; 0 = none
  /// What is beyond a sensor without accelerometer: its inertia is taken for a force of the hand.
  Payload felt;
};

/// Standard deviations of white noise, of one sample unless it says otherwise.
struct Noise {
  double force = 0.0;   ///< force noise, N/sqrt(Hz), with the accelerometer's effect on the payload
  double torque = 0.0;  ///< torque noise, likewise, Nm/sqrt(Hz)
  Eigen::VectorXd joint;       ///< noise of the joint torque sensors, Nm
  double link_encoder = 0.0;   ///< rad
  double motor_encoder = 0.0;  ///< rad at the joint
};

/// Properties of the device that do not depend on the posture.
struct LoopDevice {
  tracking::Loop loop;
  WrenchPath wrench;
};

/// Linear loop in discrete time: x' = A x + B_push f + B_motor d + B_noise e, y = C x. Positions
/// are deviations from rest.
struct HandleLoop {
  Eigen::MatrixXd A;
  /// Input matrix of a force on the hand's mass along the axes of H (3 columns), N.
  Eigen::MatrixXd B_push;
  /// Input matrix of torques on the motors (n columns), Nm.
  Eigen::MatrixXd B_motor;
  /// Input matrix of unit deviations of the noise: force, torque (6), joint torques, link and motor
  /// encoders.
  Eigen::MatrixXd B_noise;
  /// Output matrix, along the axes of H: velocity of the handle, force of the hand on it, position
  /// of the handle, position of the twin (3 rows each).
  Eigen::MatrixXd C;
  double period_s = 1e-3;
};

/// Linearises the loop in posture `q` (gantry first) with `hand` on the handle; `plant` holds
/// deviations unknown to the controller.
HandleLoop linearise(const LoopDevice& device, const tracking::TruePlant& plant, const Body& body,
                     const person::HandImpedance& hand, const Noise& noise,
                     const Eigen::VectorXd& q);

/// Smallest mass, kg, from which `body`, its inertia in proportion to its mass, does not swing ever
/// wider in `hand`, to 3 %: 0 where none from 0.01 kg on does, infinite where all up to 100 kg do.
double lightest_mass(const LoopDevice& device, const tracking::TruePlant& plant, Body body,
                     const person::HandImpedance& hand, const Eigen::VectorXd& q);

/// Solves (z 1 - A) x = b and its transpose for many z: A is brought to Hessenberg form once.
class Resolvent {
 public:
  explicit Resolvent(const Eigen::MatrixXd& A);

  /// Factorises for z; solve() and solve_transposed() use the last call.
  void at(std::complex<double> z);
  Eigen::MatrixXcd solve(const Eigen::MatrixXd& B) const;             ///< (z 1 - A)^-1 B
  Eigen::MatrixXcd solve_transposed(const Eigen::MatrixXd& C) const;  ///< C (z 1 - A)^-1

 private:
  Eigen::MatrixXd H_, Q_;           // A = Q H Q^T
  Eigen::MatrixXcd U_;              // upper factor, its rows in the order of the pivots
  Eigen::VectorXcd multipliers_;    // multiplier per step of the elimination
  std::vector<bool> is_exchanged_;  // whether step i exchanged rows i and i + 1
};

}  // namespace hg::handle_loop

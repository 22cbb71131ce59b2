/// A hand that feels a twin through drives that follow positions, as a linear loop.
///
/// The twin moves by the wrench, late; the drives carry the handle after it, through elastic joints
/// and later still; hand and the mass beyond the sensor answer. Along one direction, with the force
/// H(s) x that the sensor shows when the twin moves by x, the twin swings without growing where
/// m s^2 + b s + K + H(s) = 0 has no root on the right. On its border, s = j w, the loop's damping
/// b + Im H / w is zero and K = m w^2 - Re H. The device stands in its start posture, its axes do
/// not affect one another, friction is left out. SI units. Set-up code: it allocates.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "hg/config/simulation/simulation.h"
#include "hg/core/stacked.h"

namespace hg::check {

/// Hand behind its grip; [A] the preset `normal` of a script, to the side.
struct FeelingHand {
  double stiffness = 150.0, damping = 15.0, mass = 1.5;  ///< N/m, Ns/m, kg
  double grip_stiffness = 1000.0, grip_damping = 15.0;   ///< N/m, Ns/m
};

/// Mean delay from a wrench to what the drives follow: sensor, low-pass, half a period over which
/// the wrench acts, and way to the drives, s.
double drive_delay(const config::SimulatedDeviceConfig& device);

class DriveLoop {
 public:
  /// For a device whose plant has position drives, at `q` (gantry first), the gantry at rest;
  /// columns of `directions`: unit vectors in B, which the other functions count from 0.
  DriveLoop(const config::SimulatedDeviceConfig& device, const VectorPM& q,
            const Eigen::Matrix3Xd& directions = Eigen::Matrix3d::Identity(),
            const FeelingHand& hand = {});

  /// Largest stiffness of a wall across a direction at which a twin of `mass` (kg) and `damping`
  /// (Ns/m, of the wall, too) does not shake, N/m: 0 where it shakes without a wall, infinite where
  /// nothing makes it shake.
  double stiffest_wall(int direction, double mass, double damping) const noexcept;

  /// Mass from which a twin with `damping` does not shake without a wall, kg.
  double lightest_mass(int direction, double damping) const noexcept;

 private:
  std::vector<double> w_;                                    ///< rad/s
  std::vector<std::vector<std::complex<double>>> response_;  ///< H along each direction, N/m
};

}  // namespace hg::check

/// Observers of one manipulator joint with an elastic actuator: link side and motor side.
///
/// [C] 2. Velocities never come from the torque sensor: its derivative is too noisy.
#pragma once

#include "hg/controller/estimation/low_pass.h"

namespace hg::estimation {

/// Link side: the reference's acceleration predicts, the encoder corrects.
struct LinkObserver {
  double q = 0.0, dq = 0.0;
};

/// Advances by one period: `ddq` acted since the last sample, `q_measured` is unwrapped. `pole` is
/// the double pole of the estimation error.
inline void observe(double pole, double dt, double ddq, double q_measured,
                    LinkObserver& link) noexcept {
  link.q += dt * link.dq + 0.5 * dt * dt * ddq;
  link.dq += dt * ddq;
  const double innovation = q_measured - link.q;
  link.q += (1.0 - pole * pole) * innovation;
  link.dq += (1.0 - pole) * (1.0 - pole) / dt * innovation;
}

/// Motor side: the encoder is fine enough for its difference, filtered.
struct MotorObserver {
  double theta = 0.0, dtheta = 0.0;
};

/// Advances by one period; `theta_measured` is unwrapped, `pole` is that of the low-pass of the
/// speed.
inline void observe(double pole, double dt, double theta_measured, MotorObserver& motor) noexcept {
  low_pass(pole, (theta_measured - motor.theta) / dt, motor.dtheta);
  motor.theta = theta_measured;
}

}  // namespace hg::estimation

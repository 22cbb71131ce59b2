#include "hg/controller/estimation/gantry_observer.h"

#include "hg/controller/estimation/low_pass.h"

namespace hg::estimation {

GantryGains gantry_gains(double pole_Hz, double dt) noexcept {
  const double p = low_pass_pole(pole_Hz, dt);
  return {.q = 1.0 - p * p * p,
          .dq = 1.5 * (1.0 - p) * (1.0 - p) * (1.0 + p) / dt,
          .disturbance = (1.0 - p) * (1.0 - p) * (1.0 - p) / (dt * dt)};
}

void observe(const DriveModel& drive, const GantryGains& gains, double dt, double q_measured,
             double dq_cmd_delayed, GantryObserver& axis) noexcept {
  axis.ddq = drive_acceleration(drive, axis.dq, dq_cmd_delayed) + axis.disturbance;
  axis.q += dt * axis.dq + 0.5 * dt * dt * axis.ddq;
  axis.dq += dt * axis.ddq;

  const double innovation = q_measured - axis.q;
  axis.q += gains.q * innovation;
  axis.dq += gains.dq * innovation;
  axis.disturbance += gains.disturbance * innovation;
}

}  // namespace hg::estimation

/// Kalman filter of one gantry axis with the drive model: position, speed, and an acceleration that
/// the model does not contain.
///
/// Model, [C] 2: q' = v + n_q,  v' = clip((u - v) / lag) + d + n_v,  d' = n_d,  y = q + n_y; u is
/// the command that has passed the dead time. n_* are white with (two-sided) densities S_*. With
/// one number, a = 2 pi f, the gains are those of a triple pole a of the model without drive. They
/// are at the same time the stationary gains of the Kalman filter for
///   S_q = 3 a^2 S_y,  S_v = (3 a^4 + 16 a^3 b + 6 a^2 b^2) S_y,  S_d = a^6 S_y,  b = 1 / lag:
/// the spectra |closed loop|^2 / |open loop|^2 and 1 + sum S_i |G_i|^2 / S_y are equal, term by
/// term in the frequency, and all densities are positive for every f. So f states how much is
/// trusted: the encoder (large) or the drive model (small). Exact for small periods.
/// [C] 2 has f = 8 Hz; a gantry that shakes at 4-16 Hz needs up to 40 Hz.
#pragma once

#include "hg/signals/drive_model.h"

namespace hg::estimation {

/// q, dq and the acceleration disturbance d; ddq is what the model gives with it.
struct GantryObserver {
  double q = 0.0, dq = 0.0, ddq = 0.0;
  double disturbance = 0.0;
  CommandDelay delay;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const GantryObserver& axis) {
  const auto& [q, dq, ddq, disturbance, delay] = axis;
  hash.mix(q, dq, ddq, disturbance);
}

/// Corrections of q, dq and the disturbance per innovation of the position.
struct GantryGains {
  double q = 0.0, dq = 0.0, disturbance = 0.0;
};

/// Stationary gains for a = 2 pi `pole_Hz`, > 0.
GantryGains gantry_gains(double pole_Hz, double dt) noexcept;

/// Advances by one period: predicts with the drive model, corrects by the encoder (unwrapped).
void observe(const DriveModel& drive, const GantryGains& gains, double dt, double q_measured,
             double dq_cmd_delayed, GantryObserver& axis) noexcept;

}  // namespace hg::estimation

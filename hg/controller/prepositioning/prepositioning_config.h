/// Set-up data of the motion of the gantry.
#pragma once

namespace hg::prepositioning {

/// Set-up data.
struct PrepositioningConfig {
  double dq_max = 1.5;   ///< Largest speed, m/s or rad/s
  double k_ppu = 4.0;    ///< Gain of (27), 1/s; below 1 / (4 lag) there is no overshoot
  double ddq_max = 2.0;  ///< Deceleration that can be relied on, m/s^2 or rad/s^2
  /// Speed towards a limit, m/s or rad/s, that the arm is trusted to compensate in front of it.
  double taken_back = 0.25;
};

}  // namespace hg::prepositioning

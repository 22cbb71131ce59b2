/// How stiff a surface or a spring of a twin may be on a device, how fast it may swing, and why.
///
/// Sources: Colgate and Schenkel 1997 (passivity of sampled data); docs/environment.md (what was
/// measured). SI units at the handle, at the start of the twin.
#pragma once

#include "hg/config/device.h"
#include "hg/config/scenario.h"
#include "hg/config/twin.h"
#include "hg/inspection/findings.h"

namespace hg::inspection {

/// What the limits follow from. The acceleration is what the motors can brake the handle with, or
/// the rating of its Cartesian limits where the law does not know them; without either it is
/// infinite.
struct StiffnessLimits {
  double mass = 0.0;                ///< of the twin in the direction in which it is lightest, kg
  double damping = 0.0;             ///< of the twin in that direction, Ns/m
  double period = 0.0;              ///< T, s
  double delay = 0.0;               ///< T_d of the wrench: sensor, low-pass and torque loop, s
  double acceleration = kInfinity;  ///< a, along the worst axis of B, m/s^2

  /// Up to here T_d turns what swings by 16.5 degrees at most. Measured: 6 kg and 3 kg on surfaces
  /// are calm at 8.2 Hz and not at 11.6 Hz with 6 ms.
  double frequency_Hz() const noexcept;
  /// m (2 pi f)^2, N/m.
  double by_frequency() const noexcept;
  /// b / (T / 2 + T_d), N/m: passive in any hand, with `extra` Ns/m of a surface.
  double by_passivity(double extra) const noexcept;
  /// m (a / v)^2, N/m: a body that meets it with v asks for no more than a.
  double by_acceleration(double speed) const noexcept;
  /// a sqrt(m / K), m/s: the fastest that may meet it.
  double meeting_speed(double stiffness) const noexcept;
};

/// With which a hand meets a surface that it feels for, m/s; [A].
inline constexpr double kFeelingSpeed = 0.1;

StiffnessLimits stiffness_limits(const config::Device& device, const config::Twin& twin);

/// A note with the limits, and a warning for each spring beyond them.
void inspect_stiffness(const config::Device& device, const config::Twin& twin, Collector& out);

/// A warning for each surface beyond them.
Findings inspect_surfaces(const config::Scenario& scenario);

}  // namespace hg::inspection

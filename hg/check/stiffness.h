/// Limits of stiffness and oscillation frequency for a surface or a spring of a twin on a device.
///
/// Sources: Colgate and Schenkel 1997 (passivity of sampled data); docs/concepts/environment.md
/// (measurements). SI units at the handle, at the start of the twin.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/twin.h"
#include "hg/controller/rendering/surfaces/surface.h"

namespace hg::check {

/// Whether something that feels like `mass` (kg) can be pushed; where no joint moves the handle
/// along any direction the mass is infinite, or nearly.
constexpr bool can_be_pushed(double mass) noexcept { return mass < 1e6; }

/// What a twin feels like at its handle where it is lightest, as TwinModel::felt_scale scales it.
struct FeltTwin {
  Interval mass;         ///< along the directions in which it moves, kg
  double damping = 0.0;  ///< in the direction of the lightest, Ns/m
};
FeltTwin felt_twin(const config::Twin& twin);

/// Damping by all elements of a twin while its joints move at `dq` per unit of speed at the handle,
/// Ns/m, or Nms/rad for a turn.
double felt_damping(const rendering::TwinModel& twin, const Eigen::VectorXd& dq);

/// Where hand, twin and drives that follow positions do not swing together.
struct CalmTwin {
  std::array<double, 3> stiffness = {};  ///< stiffest wall across x, y, z of B, N/m
  std::array<double, 3> mass = {};       ///< lightest twin without a wall along them, kg
  /// Stiffest for each surface, as felt, across its faces and with its damping, N/m; infinite for
  /// stops, 0 where the twin shakes without a surface.
  std::vector<double> surfaces;
};

/// Quantities that determine the limits. The acceleration is the deceleration of the handle
/// available from the motors, or the rating of its Cartesian limits where the law does not model
/// the motors; without either it is infinite.
struct StiffnessLimits {
  /// Mass of the twin as it is felt, TwinModel::felt_scale, where it is lightest, kg.
  double mass = 0.0;
  double damping = 0.0;             ///< damping of the twin in that direction, as it is felt, Ns/m
  double period = 0.0;              ///< T, s
  double delay = 0.0;               ///< delay T_d of the wrench: sensor, low-pass and drives, s
  double acceleration = kInfinity;  ///< a, along the worst axis of B, m/s^2

  /// Of drives that follow positions, see DriveLoop; empty for others.
  std::optional<CalmTwin> calm = {};

  /// Frequency up to which T_d shifts the phase of an oscillation by 16.5 degrees at most.
  /// Measured: 6 kg and 3 kg on surfaces come to rest at 8.2 Hz but not at 11.6 Hz, which with 4 ms
  /// are 12 and 16.7 degrees. With `calm` that of by_frequency(), a quarter of its turn at most.
  double frequency_Hz() const noexcept;
  /// Stiffness limit by frequency: m (2 pi f)^2, with `calm` the least of its axes, N/m.
  double by_frequency() const noexcept;
  /// The same for one of the surfaces that the limits were made for, N/m.
  double by_frequency(std::size_t surface) const noexcept;
  /// Stiffness limit by passivity: b / (T / 2 + T_d), N/m; passive in any hand, with `extra` Ns/m
  /// of a surface.
  double by_passivity(double extra) const noexcept;
  /// Stiffness limit by acceleration: m (a / v)^2, N/m; a body that meets it with v needs no more
  /// than a.
  double by_acceleration(double speed) const noexcept;
  /// Largest speed on contact: a sqrt(m / K), m/s.
  double meeting_speed(double stiffness) const noexcept;
};

/// Speed of a hand that explores a surface, m/s; [A].
inline constexpr double kFeelingSpeed = 0.1;

/// Limits of a twin on a device, in front of the surfaces of a scenario.
StiffnessLimits stiffness_limits(const config::SimulatedDeviceConfig& device,
                                 const config::Twin& twin,
                                 std::span<const surfaces::Surface> surfaces = {});

/// Adds a note with the limits, and a warning for each spring beyond them.
void inspect_stiffness(const config::SimulatedDeviceConfig& device, const config::Twin& twin,
                       std::span<const surfaces::Surface> surfaces, Collector& out);

/// Warnings for each surface beyond the stiffness limits.
Findings inspect_surfaces(const config::Scenario& scenario);

}  // namespace hg::check

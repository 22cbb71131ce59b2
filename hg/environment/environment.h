/// The force of virtual surfaces on a point, by a proxy that never enters them.
///
/// The handle may enter a surface, its proxy stays outside and is where the handle would be if the
/// surface were hard; a spring pulls the handle towards it. The way of the proxy is followed, so
/// that no wall is too thin. One proxy for all surfaces: touching solids make one.
///
/// Sources: C. Zilles, K. Salisbury, A constraint-based god-object method for haptic display, IROS
/// 1995 (active planes); D. Ruspini, K. Kolarov, O. Khatib, The haptic display of complex graphical
/// environments, SIGGRAPH 1997 (way of the proxy, friction as a cone); J. E. Colgate, G. Schenkel,
/// Passivity of a class of sampled-data systems, J. Robotic Systems 14(1), 1997 (K < 2 b / T); K.
/// Hunt, F. Crossley, J. Applied Mechanics 42, 1975 (damping that begins with the depth).
/// Differs from them: docs/environment.md.
///
/// SI units, frame B. No allocation after construction. At most kMaxSweeps searches of the way of
/// the proxy in a step.
#pragma once

#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/environment/cast.h"
#include "hg/environment/nearest.h"
#include "hg/environment/planes.h"
#include "hg/environment/surface.h"
#include "hg/signals/state.h"

namespace hg::environment {

inline constexpr std::size_t kMaxSurfaces = 64;
inline constexpr std::size_t kMaxStopTriangles = 1500;  ///< of all stops: each costs time
inline constexpr int kMaxRounds = 4;  ///< in which the proxy follows a curved surface
inline constexpr int kMaxSweeps = 5 * kMaxRounds;

inline constexpr double kFullDamping =
    2.0;  ///< force of the spring from which damping acts in full, N
inline constexpr double kRecovery = 3e-3;  ///< speed at which a dent is filled again, m/s
// of what comes in to a surface that says no damping:
inline constexpr double kStopping = 15e-3;  ///< time constant with which it is stopped, s
inline constexpr double kImpact = 0.02;     ///< from which speed on, m/s

/// Throws SetupError naming the first surface that cannot be.
void check(const std::vector<Surface>& surfaces);

/// Part of the copyable state of a cycle.
struct State {
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();
  bool is_started = false;  ///< false: the proxy starts where the handle is
  // where the device cannot push as hard as the surface would
  double dent = 0.0;       ///< by which the surface has given way along its normal, m
  double taken = 0.0;      ///< energy that this contact has taken and not given back, J
  double stiffness = 0.0;  ///< of the surfaces that push, N/m
  double pressed = 0.0;    ///< depth of the handle beyond the dent, m
};

class Environment {
 public:
  Environment() = default;  ///< without surfaces
  /// `period` of the steps, s; `mass` (kg) of the body that meets them, where it is lightest and
  /// heaviest, for the damping of those that do not say theirs. Throws SetupError as check().
  Environment(std::vector<Surface> surfaces, double period, const Interval& mass);

  const std::vector<Surface>& surfaces() const noexcept { return surfaces_; }

  /// Whether some surfaces are met like a stop. Those do not push.
  bool has_stops() const noexcept { return has_stops_; }
  /// The planes of such surfaces that a handle with this `velocity` has least to spare of, when it
  /// brakes with `ddq_max` (m/s^2). Others, and those too far to matter, have no surface.
  std::array<Facing, kMostFacing> stops(const Eigen::Vector3d& position,
                                        const Eigen::Vector3d& velocity,
                                        double ddq_max) const noexcept;

  /// `position` and `velocity` of the handle at the begin of a sample, `push` (N) of all else that
  /// acts on it. The spring acts as in the middle of the sample, where the handle is half a period
  /// later; else it would give energy. A handle that starts inside a solid is free until it has
  /// left it. `mass_scale`: of the body now, over its mass at set-up.
  ContactReport step(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                     const Eigen::Vector3d& push, State& state,
                     double mass_scale = 1.0) const noexcept;

  /// After a step(): of the force `contact` the device does not give `missing` (N, of its size).
  /// The surface gives way until its spring pushes no harder than the device, so that it never
  /// gives back more than it has taken. It recovers slowly, from the energy that it has taken.
  void give_way(const ContactReport& contact, double missing, const Eigen::Vector3d& velocity,
                State& state) const noexcept;

 private:
  struct Found {
    Hit hit;
    int surface = -1;
  };
  Found first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const noexcept;
  bool add(const Found& met, double mass_scale, Planes& planes) const noexcept;
  void slide(const Eigen::Vector3d& handle, double mass_scale, Planes& planes,
             Eigen::Vector3d& proxy) const noexcept;
  void follow(const Eigen::Vector3d& handle, double mass_scale, Planes& planes,
              Eigen::Vector3d& proxy) const noexcept;
  double damping_of(const Surface& surface, double mass_scale) const noexcept;

  void catch_it(const Spread& spread, double mass_scale, const Eigen::Vector3d& velocity,
                const Eigen::Vector3d& push, ContactReport& contact, State& state) const noexcept;

  std::vector<Surface> surfaces_;
  Interval mass_;  ///< of the body, kg
  double period_ = 0.0;
  bool has_stops_ = false;
};

}  // namespace hg::environment

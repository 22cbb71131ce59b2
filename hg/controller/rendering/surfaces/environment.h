/// Force of virtual surfaces on a point, by a proxy that never enters them.
///
/// The handle may enter a surface, its proxy stays outside at the place where the handle would be
/// if the surface were hard; a spring pulls the handle towards it. The path of the proxy is traced,
/// so that no wall is too thin. One proxy serves all surfaces: touching solids act as one.
///
/// Sources: C. Zilles, K. Salisbury, A constraint-based god-object method for haptic display, IROS
/// 1995 (active planes); D. Ruspini, K. Kolarov, O. Khatib, The haptic display of complex graphical
/// environments, SIGGRAPH 1997 (way of the proxy, friction as a cone); J. E. Colgate, G. Schenkel,
/// Passivity of a class of sampled-data systems, J. Robotic Systems 14(1), 1997 (K < 2 b / T); K.
/// Hunt, F. Crossley, J. Applied Mechanics 42, 1975 (damping that begins with the depth).
/// Differs from them: docs/concepts/environment.md.
///
/// SI units, frame B. No allocation after construction. At most kMaxSweeps searches along the path
/// of the proxy in a step.
#pragma once

#include <vector>

#include "hg/controller/rendering/surfaces/cast.h"
#include "hg/controller/rendering/surfaces/nearest.h"
#include "hg/controller/rendering/surfaces/planes.h"
#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/signals/state.h"

namespace hg::surfaces {

inline constexpr std::size_t kMaxSurfaces = 64;
// Limits for all stops together, for their computing time:
inline constexpr std::size_t kMaxStopTriangles = 1500;
inline constexpr std::size_t kMaxStopSearches = 3 * kMaxStopTriangles;  ///< points times triangles
inline constexpr int kMaxRounds = 4;  ///< rounds in which the proxy follows a curved surface
inline constexpr int kMaxSweeps = 5 * kMaxRounds;

inline constexpr double kFullDamping = 2.0;  ///< spring force from which damping acts in full, N
inline constexpr double kRecovery = 3e-3;    ///< speed at which a dent recovers, m/s
// impacts on a surface without a damping of its own:
inline constexpr double kStopping = 15e-3;  ///< time constant of stopping an impact, s
inline constexpr double kImpact = 0.02;     ///< lowest speed of an impact, m/s

/// Throws SetupError naming the first invalid surface.
void check_surfaces(const std::vector<Surface>& surfaces);

/// State of the rendering: part of the copyable state of a cycle.
struct EnvironmentState {
  Eigen::Vector3d proxy = Eigen::Vector3d::Zero();
  bool is_started = false;  ///< false: the proxy starts where the handle is
  // where the device cannot push as hard as the surface should
  double dent = 0.0;       ///< displacement of the yielding surface along its normal, m
  double taken = 0.0;      ///< energy absorbed and not returned by this contact, J
  double stiffness = 0.0;  ///< stiffness of the pushing surfaces, N/m
  double pressed = 0.0;    ///< depth of the handle beyond the dent, m
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const EnvironmentState& state) {
  const auto& [proxy, is_started, dent, taken, stiffness, pressed] = state;
  hash.mix(proxy, is_started, dent, taken);
}

class Environment {
 public:
  Environment() = default;  ///< no surfaces
  /// `period` of the steps, s; `mass` (kg) of the body that meets the surfaces, the lightest and
  /// heaviest, for the damping of surfaces without a damping of their own. Throws SetupError as
  /// check_surfaces().
  Environment(std::vector<Surface> surfaces, double period, const Interval& mass);

  const std::vector<Surface>& surfaces() const noexcept { return surfaces_; }

  /// Whether some surfaces act as stops. Those exert no force.
  bool has_stops() const noexcept { return has_stops_; }
  /// Number of triangles of all meshes that are stops.
  std::size_t stop_triangles() const noexcept { return stop_triangles_; }
  /// Planes of stop surfaces with the smallest margin for a handle with this `velocity` that brakes
  /// with `ddq_max` (m/s^2). Unused entries, and planes too far to matter, have no surface. Around
  /// the handle is a sphere of `radius` (m); distances are those of its centre.
  std::array<Facing, kMostFacing> stops(const Eigen::Vector3d& position,
                                        const Eigen::Vector3d& velocity, double ddq_max,
                                        double radius = 0.0) const noexcept;

  /// Computes the contact force. `position` and `velocity` of the handle at the begin of a sample,
  /// `push` (N): all other forces on it. The spring is evaluated in the middle of the sample, where
  /// the handle is half a period later; else it would generate energy. A handle that starts inside
  /// a solid is free until it has left it. `mass_scale`: present mass of the body over its mass at
  /// set-up.
  ContactReport step(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity,
                     const Eigen::Vector3d& push, EnvironmentState& state,
                     double mass_scale = 1.0) const noexcept;

  /// Call after step(): of the force `contact` the device lacks `missing` (N, magnitude). The
  /// surface yields until its spring pushes no harder than the device, so that it never returns
  /// more energy than it has absorbed. It recovers slowly, using the absorbed energy.
  void give_way(const ContactReport& contact, double missing, const Eigen::Vector3d& velocity,
                EnvironmentState& state) const noexcept;

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
                const Eigen::Vector3d& push, ContactReport& contact,
                EnvironmentState& state) const noexcept;

  std::vector<Surface> surfaces_;
  Interval mass_;  ///< mass of the body, kg
  double period_ = 0.0;
  bool has_stops_ = false;
  std::size_t stop_triangles_ = 0;
};

}  // namespace hg::surfaces

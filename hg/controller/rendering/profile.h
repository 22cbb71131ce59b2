/// Torque or force and friction over the position of a joint: detents, gas springs, latches.
///
/// Between points the values follow monotone cubics: continuous with their slope, and nowhere
/// beyond the two points beside them. Torque is a function of position alone and so has a
/// potential: a path that ends where it began takes no work. No allocation after construction. SI
/// units.
///
/// Source: Fritsch and Butland, A method for constructing local monotone piecewise cubic
/// interpolants, SIAM J. Sci. Stat. Comput. 5(2), 1984.
#pragma once

#include <string>
#include <vector>

#include "hg/core/interval.h"

namespace hg::rendering {

struct ProfilePoint {
  double q = 0.0;         ///< Position, rad or m
  double torque = 0.0;    ///< Nm or N; positive pulls towards smaller positions, like a spring
  double friction = 0.0;  ///< Coulomb friction, Nm or N, >= 0
};

inline constexpr int kMaxProfilePoints = 100;

/// What is wrong with a profile; empty = nothing. `repeat` is the distance after which the points
/// begin again, infinite = they do not.
std::string profile_fault(const std::vector<ProfilePoint>& points, double repeat);

class Profile {
 public:
  Profile() = default;  ///< No profile: zero everywhere
  /// Throws SetupError with profile_fault().
  explicit Profile(const std::vector<ProfilePoint>& points, double repeat = kInfinity);

  bool empty() const noexcept { return q_.empty(); }
  /// Torque at q, Nm or N. Beyond the points it is that of the nearest one.
  double torque(double q) const noexcept { return empty() ? 0.0 : value(torque_, q); }
  /// Coulomb friction at q, Nm or N.
  double friction(double q) const noexcept { return empty() ? 0.0 : value(friction_, q); }
  /// Largest magnitude of the slope of the torque, Nm/rad or N/m.
  double steepest() const noexcept { return steepest_; }

 private:
  struct Curve {
    std::vector<double> y, slope;  ///< At each of q_
  };

  Curve curve(std::vector<double> y) const;
  double value(const Curve& curve, double q) const noexcept;
  double find_steepest() const noexcept;

  std::vector<double>
      q_;  ///< Positions of the points; with a repeat the first one again at the end
  double repeat_ = kInfinity;
  Curve torque_, friction_;
  double steepest_ = 0.0;
};

}  // namespace hg::rendering

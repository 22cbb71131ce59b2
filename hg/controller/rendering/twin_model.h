/// The digital twin: a serial chain with limits, springs, profiles, dampers, friction, closers and
/// locks.
///
/// Set-up data: filled by config, checked once, constant afterwards. What may change while the twin
/// runs starts with the values here and is kept in TwinParameters. SI units.
#pragma once

#include <string>
#include <vector>

#include "hg/controller/rendering/profile.h"
#include "hg/core/types.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/chain_model.h"

namespace hg::rendering {

/// Pulls a joint towards its present lower limit q_min with torque + stiffness (q - q_min), and
/// lets it close no faster than `speed`.
struct Closer {
  double torque = 0.0;       ///< Nm or N
  double stiffness = 0.0;    ///< Nm/rad or N/m; > 0 needs a lower limit
  double speed = kInfinity;  ///< largest speed towards the lower limit, > 0, rad/s or m/s
};

/// Properties of one degree of freedom. The degrees of freedom of a floating joint (three linear,
/// three angular, in the body's frame) have damping and friction only.
struct TwinDof {
  std::string name;      ///< Name of the joint; floating joints append " x" ... " rz"
  int q_index = -1;      ///< Coordinate in q_a; -1 for floating joints
  bool is_angle = true;  ///< true: rad and Nm, false: m and N
  limits::JointLimits limits;
  double stiffness = 0.0;          ///< spring, Nm/rad or N/m
  double rest = 0.0;               ///< position where the spring part is zero
  double preload = 0.0;            ///< constant part of the spring, pulls towards smaller positions
  double damping = 0.0;            ///< Nms/rad or Ns/m
  double friction = 0.0;           ///< Coulomb friction, Nm or N
  double quadratic_damping = 0.0;  ///< torque = this |dq| dq, Nms^2/rad^2 or Ns^2/m^2
  Closer closer;
  Profile profile;  ///< torque and friction over position, besides the others
};

/// Matrix of chain a (n_a x n_a), for example its mass matrix or the factor of it.
using MatrixA = MatrixUpTo<kMaxTwin, kMaxTwin>;

struct JointCondition {
  int dof = 0;
  Interval range;  ///< Condition is true while the position is inside
};

inline constexpr int kMaxSpheres = 8;
inline constexpr int kMaxLocks = 4;
inline constexpr int kMaxConditionalLimits = 4;
inline constexpr Interval kMassScale = {0.1, 10.0};  ///< Range of TwinModel::mass_scale
inline constexpr Interval kFeltScale = {0.1, 10.0};  ///< Range of TwinModel::felt_scale

enum class Way { kUpper, kLower };

/// Holds one joint at `position` while all conditions are true. A joint that is not there yet when
/// the conditions become true is latched: it may move towards `position` but not away from it.
///
/// With `teeth` it is a ratchet instead: the joint moves freely one way, and back to the last tooth
/// that it has passed.
struct Lock {
  std::string name;
  int dof = 0;
  double position = 0.0;   ///< rad or m; of a ratchet that of one tooth
  double teeth = 0.0;      ///< Distance of the teeth, rad or m; 0 = no ratchet
  Way free = Way::kUpper;  ///< The way in which a ratchet is free
  std::vector<JointCondition> engaged_while;
};

enum class Moving { kEitherWay, kLower, kUpper };

/// Limits that hold in addition while all conditions are true; the tighter one counts. Positions
/// travel there and back (limits::advanced), speed and acceleration change at once.
struct ConditionalLimit {
  std::string name;
  int dof = 0;
  limits::JointLimits limits;
  Moving moving = Moving::kEitherWay;  ///< Direction in which the speed limit holds
  std::vector<JointCondition> conditions;
};

/// A sphere fixed to a link, which surfaces that are stops keep out.
struct CollisionSphere {
  int frame = -1;                               ///< Index of the link's frame
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< Centre in that frame, m
  double radius = 0.0;                          ///< m, >= 0
};

struct TwinModel {
  model::ChainModel chain;
  int end_effector = -1;      ///< Index of frame E
  ConfigurationA q_start;     ///< Coordinates at the start
  std::vector<TwinDof> dofs;  ///< Degrees of freedom, one per velocity of the chain
  std::vector<Lock> locks;    ///< at most kMaxLocks
  std::vector<ConditionalLimit> conditional_limits;  ///< at most kMaxConditionalLimits
  std::vector<CollisionSphere> spheres;              ///< at most kMaxSpheres
  Vector6 w_ref = Vector6::Zero();  ///< reference wrench of [HG] (9), at E, resolved in B
  double mass_scale = 1.0;          ///< Factor of all masses, 0.1..10
  /// Factors of the user's wrench on the twin: forces along and torques about the axes of B,
  /// 0.1..10. What the twin does is felt divided by them.
  Vector6 felt_scale = Vector6::Ones();
};

/// Throws SetupError naming the first inconsistency.
void check_twin_model(const TwinModel& twin);

/// Mass that a force at the end effector has to move, at the start of the twin.
struct FeltMass {
  /// Masses in the lightest and the heaviest direction, kg; directions in which the twin cannot
  /// move do not count. Infinite where there is no other.
  Interval mass = {kInfinity, kInfinity};
  /// Joint velocity that moves the end effector with 1 m/s in the lightest direction, or with
  /// 1 / sqrt(s) m/s where forces are scaled by s.
  VectorA dq;
};
/// `scale`: factors of forces along x, y, z of B on the twin.
FeltMass felt_mass(const TwinModel& twin, const Eigen::Vector3d& scale = Eigen::Vector3d::Ones());

/// Position of degree of freedom `dof`, which is not one of a floating joint; rad or m.
double position_of(const TwinModel& twin, int dof, const ConfigurationA& q_a) noexcept;

/// Whether all conditions are true.
bool are_true(const TwinModel& twin, const std::vector<JointCondition>& conditions,
              const ConfigurationA& q_a) noexcept;

}  // namespace hg::rendering

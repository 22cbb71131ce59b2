/// The digital twin: a serial chain with limits, springs, dampers, friction and locks.
///
/// Set-up data: filled by config, checked once, constant afterwards. SI units.
#pragma once

#include <string>
#include <vector>

#include "hg/core/types.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/chain.h"

namespace hg::rendering {

/// What acts along one degree of freedom. The degrees of freedom of a floating joint (three linear,
/// three angular, in the body's frame) have damping and friction only.
struct TwinDof {
  std::string name;      ///< of the joint; floating joints append " x" ... " rz"
  int q_index = -1;      ///< coordinate in q_a; -1 for floating joints
  bool is_angle = true;  ///< rad and Nm, otherwise m and N
  limits::JointLimits limits;
  double stiffness = 0.0;  ///< spring, Nm/rad or N/m
  double rest = 0.0;       ///< position where the spring part is zero
  double preload = 0.0;    ///< constant part of the spring, pulls towards smaller positions
  double damping = 0.0;    ///< Nms/rad or Ns/m
  double friction = 0.0;   ///< Coulomb friction, Nm or N
};

struct JointCondition {
  int dof = 0;
  Interval range;  ///< true while the position is inside
};

inline constexpr int kMaxLocks = 4;

/// Holds one joint at `position` while all conditions are true. A joint that is not there yet when
/// the conditions become true is latched: it may move towards `position` but not away from it.
struct Lock {
  std::string name;
  int dof = 0;
  double position = 0.0;
  std::vector<JointCondition> engaged_while;
};

struct TwinModel {
  model::Chain chain;
  int end_effector = -1;      ///< frame E
  ConfigurationA q_start;     ///< coordinates at the start
  std::vector<TwinDof> dofs;  ///< one per velocity of the chain
  std::vector<Lock> locks;    ///< at most kMaxLocks
};

}  // namespace hg::rendering

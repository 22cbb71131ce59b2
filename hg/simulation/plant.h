/// The machine behind the sensors: an arm of series elastic joints under a gantry whose
/// acceleration its drives prescribe, held by a person.
///
/// Source: [HANDBOOK] 4.1-4.4. Hybrid dynamics of links and motors,
///   M ddq = tau_J + tau_stop + J^T w - c - M_mp ddq_p,  tau_J = K (theta - q) + D (theta' - q')
///   Jm theta'' = tau_motor - tau_J - viscous theta' + tau_friction,
/// in linearly implicit steps; springs, dampers, friction and stops at the end of the step.
/// Coulomb friction and closed brakes are one box problem, see friction.h.
///
/// SI units; for a prismatic joint read N for Nm and m for rad. Set-up throws SetupError. After it
/// nothing allocates or throws. Copyable: a copy goes on by itself.
#pragma once

#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/model/chain.h"
#include "hg/signals/actuator_model.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/truth.h"
#include "hg/simulation/friction.h"

namespace hg::simulation {

inline constexpr int kMaxFlexible = 8;  ///< flexible joints
inline constexpr int kMaxLinks = kMaxManipulator + kMaxFlexible;
using VectorL = VectorUpTo<kMaxLinks>;  ///< joints that the forces move: manipulator, then flexible
using MatrixL = MatrixUpTo<kMaxLinks, kMaxLinks>;
using VectorQ = VectorUpTo<kMaxGantry + kMaxLinks>;  ///< all joints, in the order of the chain

/// A joint that nobody drives: the bending of a link, of the trolley or of the gantry's frame.
struct FlexibleJoint {
  int joint = 0;           ///< its index in the chain
  double stiffness = 0.0;  ///< Nm/rad towards position 0, >= 0; 0 = it moves freely
  double damping = 0.0;    ///< Nms/rad, >= 0
};

/// Buffers at the ends of travel: they push and never pull.
struct EndStopModel {
  double stiffness = 1e5;      ///< Nm/rad, > 0; rubber on steel, assumed
  double damping_ratio = 5.0;  ///< of the joint's own inertia on it, >= 0; 5 throws back 1 %
};

/// Set-up data. Indices are those of Chain::joints(); every joint is in exactly one list.
struct PlantConfig {
  double step = 0.25e-3;         ///< s, > 0; damps 15 Hz by 1.2 % of critical, [HANDBOOK] 4.4
  std::vector<int> gantry;       ///< joints that the drives prescribe
  std::vector<int> manipulator;  ///< joints with actuators
  std::vector<FlexibleJoint> flexible;
  std::vector<ActuatorModel> actuators;  ///< one per manipulator joint
  double current_lag = 0.5e-3;           ///< from torque command to torque, s, >= 0; CONTROL_NOTES
  DriveModel drive;                      ///< of every gantry axis
  std::vector<Interval> end_stops;       ///< of the links of the manipulator; empty = none
  EndStopModel end_stop;
  VectorP q_p_start;
  VectorM q_m_start;
};

/// What drives the plant during one step.
struct PlantInput {
  VectorM tau_command;            ///< for the motors, Nm
  bool brakes_closed = true;      ///< of all manipulator joints
  VectorP dq_p_command;           ///< for the gantry's drives, before their dead time
  Vector6 w_H = Vector6::Zero();  ///< of the user on the handle, at H, in B, force first
};

/// Forces and accelerations of one step; its equations of motion hold with the M and c of its
/// start. Links: manipulator joints, then flexible ones.
struct PlantForces {
  VectorL ddq;           ///< of the links
  VectorM ddtheta;       ///< of the motors
  VectorL tau_links;     ///< of springs and dampers on the links; a manipulator's are tau_J
  VectorM tau_friction;  ///< Coulomb friction and brakes, on the motors
  VectorM tau_stop;      ///< of the end stops, on the links
  VectorP f_p;           ///< of the drives on the gantry
  int tries = 0;         ///< active sets tried for the friction
  bool is_exact = true;  ///< false: no active set was found in kMaxTries
};

struct PlantEnergy {
  double kinetic = 0.0;    ///< links, gantry and rotors, J
  double potential = 0.0;  ///< in gravity
  double spring = 0.0;     ///< joints, flexible joints and end stops

  double sum() const noexcept { return kinetic + potential + spring; }
};

/// Powers of the last step with the speeds at its end, W. Dissipated ones are >= 0.
struct PlantPower {
  double motors = 0.0, user = 0.0, gantry = 0.0;  ///< put in
  double joint_damping = 0.0, viscous_friction = 0.0, coulomb_friction = 0.0;
  double flexible_damping = 0.0, stop_damping = 0.0;

  double put_in() const noexcept { return motors + user + gantry; }
  double dissipated() const noexcept {
    return joint_damping + viscous_friction + coulomb_friction + flexible_damping + stop_damping;
  }
};

class Plant {
 public:
  /// Starts at rest, the springs carrying the weight. `handle` is the chain's frame H.
  Plant(const PlantConfig& config, const model::Chain& chain, int handle);

  /// Lives one step.
  void step(const PlantInput& input) noexcept;

  /// What is the case now; accelerations are those of the last step.
  const Truth& truth() const noexcept { return truth_; }
  /// Of the last step; zero before the first.
  const PlantForces& forces() const noexcept { return forces_; }
  PlantEnergy energy() const noexcept;
  PlantPower power() const noexcept;
  /// Largest error of the links' equations of motion in the last step, by inverse dynamics, Nm.
  double residual() noexcept;

  /// All joints, in the order of the chain.
  const VectorQ& q() const noexcept { return q_; }
  const VectorQ& dq() const noexcept { return dq_; }
  const PlantConfig& config() const noexcept { return config_; }

 private:
  PlantConfig config_;
  model::Chain chain_;
  Truth truth_;
  PlantForces forces_;
  VectorQ q_, dq_;
};

}  // namespace hg::simulation

/// The machine behind the sensors: an arm of series elastic joints under a gantry whose
/// acceleration its drives prescribe, held by a person.
///
/// Source: [HANDBOOK] 4.1-4.4. Hybrid dynamics of links and motors,
///   M ddq = tau_J + tau_stop + J^T w - c - M_mp ddq_p,  tau_J = K (theta - q) + D (theta' - q')
///   Jm theta'' = tau_motor - tau_J - viscous theta' + tau_friction,
/// in linearly implicit steps; springs, dampers, friction and stops at the end of the step.
/// Coulomb friction, closed brakes and end stops are one box problem, see friction.h.
///
/// SI units; for a prismatic joint read N for Nm and m for rad. Set-up throws SetupError. After it
/// nothing allocates or throws. Copyable: a copy goes on by itself.
#pragma once

#include <array>

#include "hg/core/types.h"
#include "hg/model/chain.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/truth.h"
#include "hg/simulation/friction.h"
#include "hg/simulation/hardware_faults.h"
#include "hg/simulation/plant_config.h"

namespace hg::simulation {

/// What drives the plant during one step.
struct PlantInput {
  VectorM tau_command;            ///< for the motors, Nm
  bool brakes_closed = true;      ///< of all manipulator joints
  HardwareFaults faults;          ///< of single brakes
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
  double spring = 0.0;     ///< joints and flexible joints

  double sum() const noexcept { return kinetic + potential + spring; }
};

/// Powers of the last step with the speeds at its end, W.
struct PlantPower {
  double motors = 0.0, user = 0.0, gantry = 0.0;                               ///< put in
  double joint_damping = 0.0, viscous_friction = 0.0, coulomb_friction = 0.0;  ///< lost, >= 0
  double flexible_damping = 0.0;                                               ///< lost, >= 0
  double end_stops = 0.0;  ///< taken by the stops; a little of it comes back
  double bystander = 0.0;  ///< taken by the bystander; what the body stores comes back

  double put_in() const noexcept { return motors + user + gantry; }
  double taken() const noexcept {
    return joint_damping + viscous_friction + coulomb_friction + flexible_damping + end_stops +
           bystander;
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
  // The equations of one step before friction and stops have had their say.
  struct Equations {
    MatrixL L;                  // Cholesky factor of the links' inertia with all that is implicit
    VectorL tau;                // torques on the links
    VectorL spring;             // transmitted on the links, were there no acceleration
    VectorM motor;              // torques on the motors
    VectorM inertia, coupling;  // of the motors with all that is implicit; to their links
  };
  // A link at an end stop: push = max(0, give (rest - speed)) with its speed away from the stop.
  struct Contact {
    int joint;
    double side, give, rest;
  };
  struct Contacts {
    std::array<Contact, kMaxManipulator> at;
    int count = 0;
  };

  model::Loads loads() const noexcept;
  void start_in_balance() noexcept;
  void move_motors(const VectorM& tau_command) noexcept;
  void meet_bystander() noexcept;
  VectorP gantry_acceleration(const VectorP& dq_p_command) noexcept;
  Contacts near_stops() const noexcept;
  Equations equations(const VectorP& ddq_p) const noexcept;
  void resist(const Equations& eq, const Contacts& contacts, const PlantInput& input) noexcept;
  double friction_bound(int joint) const noexcept;
  void accelerate(Equations& eq, const Contacts& contacts) noexcept;
  void integrate(const VectorP& ddq_p) noexcept;
  void observe() noexcept;

  PlantConfig config_;
  model::Chain chain_;
  int handle_, n_p_, n_m_, n_l_;
  int dead_steps_;
  double current_share_;                // of the way to its command that a current goes in one step
  std::array<int, kMaxLinks> links_{};  // their joints
  std::array<CommandDelay, kMaxGantry> delays_;
  std::array<BoxState, kMaxManipulator> friction_states_{}, stop_states_{};
  VectorM current_;  // as torques of the motors without the limit of their speed
  model::Jacobian J_H_;
  VectorQ q_, dq_, ddq_;
  VectorQ q_before_, dq_before_;  // at the start of the last step
  VectorQ tau_user_;              // of the user in it, on all joints
  VectorQ tau_bystander_;         // of the bystander in it, likewise
  Bystander bystander_;
  BoxProblem box_;
  BoxSolution box_solution_;
  PlantForces forces_;
  Truth truth_;
};

}  // namespace hg::simulation

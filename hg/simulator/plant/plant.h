/// The machine behind the sensors: an arm of series elastic joints under a gantry whose
/// acceleration its drives prescribe, held by a person.
///
/// Source: [HANDBOOK] 4.1-4.4. Hybrid dynamics of links and motors,
///   M ddq = tau_J + tau_stop + J^T w - c - M_mp ddq_p,  tau_J = K (theta - q) + D (theta' - q')
///   Jm theta'' = tau_motor - tau_J - viscous theta' + tau_friction,
/// in linearly implicit steps; springs, dampers, friction and stops at the end of the step.
/// Coulomb friction with its bristles, hysteresis, backlash, closed brakes and end stops are one
/// box problem, see friction.h.
///
/// SI units; for a prismatic joint read N for Nm and m for rad. Set-up throws SetupError. After it
/// nothing allocates or throws. Copyable: a copy is independent of its original.
#pragma once

#include <array>

#include "hg/core/types.h"
#include "hg/model/chain_data.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/truth.h"
#include "hg/simulator/hardware_faults.h"
#include "hg/simulator/plant/body_motion.h"
#include "hg/simulator/plant/friction.h"
#include "hg/simulator/plant/plant_config.h"
#include "hg/simulator/plant/plant_report.h"
#include "hg/simulator/sensors/torque_estimate.h"

namespace hg::simulator {

/// Inputs of the plant during one step.
struct PlantInput {
  VectorM tau_command;            ///< motor torques, Nm; not read by drives that follow positions
  DriveReference reference;       ///< of drives that follow positions
  bool brakes_closed = true;      ///< state of all brakes of manipulator joints
  HardwareFaults faults;          ///< faults of single brakes
  VectorP dq_p_command;           ///< commands to the gantry's drives, before their dead time
  Vector6 w_H = Vector6::Zero();  ///< user's wrench on the handle, at H, in B, force first
};

class Plant {
 public:
  /// Starts at rest, the springs carrying the weight. `handle` is the chain's frame H.
  Plant(const PlantConfig& config, const model::ChainModel& chain, int handle);

  /// Advances by one step.
  void step(const PlantInput& input) noexcept;

  /// True state now; accelerations are those of the last step.
  const Truth& truth() const noexcept { return truth_; }
  /// Motion of a link of the chain; accelerations are those of the last step.
  BodyMotion motion(int frame) const noexcept { return motion_of(chain_, frame, ddq_); }
  /// Jacobian of the handle for the manipulator's joints, at H, in B.
  JacobianM handle_jacobian() const noexcept;
  /// Torques that carry the links and keep them moving as they do, Nm; one per manipulator joint.
  VectorM carrying_torques() const noexcept;
  /// Forces of the last step; zero before the first.
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
  // The equations of one step before friction and stops are applied.
  struct Equations {
    MatrixL L;                  // Cholesky factor of the links' inertia with all implicit terms
    VectorL tau;                // torques on the links
    VectorL spring;             // spring torques on the links at zero acceleration
    VectorM motor;              // torques on the motors
    VectorM inertia, coupling;  // of the motors with all implicit terms; coupling to their links
  };
  struct WavePhases {
    double cogging = 0.0, ripple = 0.0;
  };
  // A force f of the box problem: motor f acts on the motor and link f on the link of a joint. Its
  // rate is motor theta' + link q' + give f + offset.
  struct Row {
    int joint = 0, slot = 0;  // slot: index of its state and its bristle
    double motor = 0.0, link = 0.0;
    double stiffness = 0.0, give = 0.0, offset = 0.0;  // of a bristle, rad/s per Nm, rad/s
    double lb = 0.0, ub = 0.0;
  };
  struct Rows {
    std::array<Row, kMaxBoxRows> all;
    int count = 0;

    void add(const Row& row) noexcept { all[count++] = row; }
    const Row& operator[](int k) const noexcept { return all[k]; }
  };
  struct Motion {
    double q, dq;
  };

  model::Loads loads() const noexcept;
  void start_in_balance() noexcept;
  VectorM follow(const PlantInput& input) noexcept;
  void move_motors(const VectorM& tau_command) noexcept;
  void meet_bystander() noexcept;
  void draw_phases() noexcept;
  Motion strayed(int axis) const noexcept;
  VectorP move_gantry(const VectorP& dq_p_command) noexcept;
  Equations equations(const VectorP& ddq_p) const noexcept;
  Rows rows(const PlantInput& input) const noexcept;
  void add_friction(int joint, int element, const PlantInput& input, Rows& rows) const noexcept;
  void add_gear(int joint, Rows& rows) const noexcept;
  void add_stop(int joint, Rows& rows) const noexcept;
  void add_touch(Row row, double depth, double speed, double stiffness, double damping,
                 Rows& rows) const noexcept;
  void resist(const Equations& eq, const Rows& rows) noexcept;
  double friction_bound(int joint) const noexcept;
  void accelerate(Equations& eq, const Rows& rows) noexcept;
  double twist_beyond_play(int joint) const noexcept;
  void stretch(const Row& row, double force, double rate) noexcept;
  void integrate(const VectorP& ddq_p) noexcept;
  void observe() noexcept;

  PlantConfig config_;
  model::ChainData chain_;
  int handle_, n_p_, n_m_, n_l_;
  int dead_steps_;
  double current_share_;  // fraction of the way to its command that a current covers in one step
  std::array<int, kMaxLinks> links_{};  // joint index of each link
  std::array<CommandDelay, kMaxGantry> delays_;
  std::array<BoxState, kMaxBoxRows> row_states_{};
  // Deflections of the bristles in series with rows, rad
  std::array<double, kMaxBoxRows> bristles_{};
  std::array<WavePhases, kMaxManipulator> wave_phases_{};
  VectorM flanks_;                           // torques of the flanks on the links, Nm
  VectorM friction_lost_, hysteresis_lost_;  // powers of the last step, W
  VectorP travel_, speed_;  // gantry position and speed as seen by its drives, without waviness
  VectorP waviness_phase_;
  PositionLoop position_loop_;
  VectorM current_;  // currents as motor torques, before the speed limit
  model::Jacobian J_H_;
  VectorQ q_, dq_, ddq_;
  VectorQ q_before_, dq_before_;  // at the start of the last step
  VectorQ tau_user_;              // user's torques in the last step, on all joints
  VectorQ tau_bystander_;         // bystander's torques in the last step, on all joints
  Bystander bystander_;
  BoxProblem box_;
  BoxSolution box_solution_;
  PlantForces forces_;
  Truth truth_;
};

}  // namespace hg::simulator

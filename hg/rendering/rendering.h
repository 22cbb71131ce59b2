/// The rendering law: from the state of device and twin and the user's wrench to
/// accelerations, integrated to the next reference.
///
/// Source: [HG] sec. VI-C; docs/law.md. One object serves one thread.
/// No allocation, noexcept after construction.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "hg/core/stage_probe.h"
#include "hg/environment/environment.h"
#include "hg/hqp/kept_problems.h"
#include "hg/hqp/solver.h"
#include "hg/rendering/device_model.h"
#include "hg/rendering/options.h"
#include "hg/rendering/reactions.h"
#include "hg/rendering/tasks.h"
#include "hg/rendering/twin_forces.h"
#include "hg/rendering/twin_model.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// What makes the twin calmer than it was set up: see hg/passivity.
struct Calming {
  double damping = 0.0;  ///< of its end effector in all directions, Ns/m
  double inertia = 1.0;  ///< factor of its inertia, without more weight
};

/// Part of the copyable state of a cycle.
struct State {
  ReferenceState reference;
  TwinState twin;
  TwinInnerState inner;
  Calming calming;                  ///< for the next step
  Vector6 touch = Vector6::Zero();  ///< on the handle, of what touches the arm: likewise
  hqp::ActiveSet active_set;
  TouchedEnds touched;   ///< by the last result; law paper only
  VectorP ddq_p;         ///< that the last result asks the gantry for; empty: nothing
  VectorM motor_torque;  ///< that the last result asks for, Nm or N; empty: none, or not known
  environment::State contact;
};

/// Throws SetupError naming the first thing in the models that the law cannot use.
void check(const DeviceModel& device, const TwinModel& twin, const Options& options);

class Rendering {
 public:
  Rendering(DeviceModel device, TwinModel twin, const Options& options,
            environment::Environment environment = {});

  const DeviceModel& device() const noexcept { return device_; }
  const TwinModel& twin() const noexcept { return twin_; }

  /// At rest: the manipulator at `q_m`, the twin at its start.
  State start(const VectorM& q_m) const;

  /// Lets a parameter of the twin change, from the next step() on.
  ChangeStatus change(const ParameterChange& change, State& state) const noexcept;

  /// Solves for the accelerations of this sample and reports why they are what they are. Needs
  /// record.robot; fills the rest that concerns device, twin, limits and solver. Does not move the
  /// state: integrate() does. `share` (0..1) of the user's wrench, the twin's springs, its weight,
  /// its reference wrench and the surfaces around it counts, so that a run against a leaning hand
  /// begins and ends without a bump. `braking_rate` > 0 (1/s) brings the twin to rest, under the
  /// same limits; with `share` 0 it is then a body without friction that nobody touches. The handle
  /// moves no faster than `handle_speed` along each axis of B (m/s), where the device has Cartesian
  /// limits for it. `gantry` says where the law may lead the gantry; state.ddq_p is then where to.
  SolverStatus step(State& state, double braking_rate, CycleRecord& record, double share = 1.0,
                    double handle_speed = kInfinity, const GantryTask& gantry = {}) noexcept;

  /// Whether the law can lead the gantry.
  bool leads_gantry() const noexcept { return tasks_.leads_gantry(); }

  /// Moves the twin at rest to where its end effector meets the handle, as far as its joints allow.
  void align(const RobotState& robot, State& state) noexcept;

  /// Keeps the reference within `largest` (rad or m) of the measured joints: where the device was
  /// left behind, reference and twin come back to it, so that nothing runs away and then snaps;
  /// [C] 6. True when it had to.
  bool stay_near(const RobotState& robot, double largest, State& state) noexcept;

  /// In the last step a joint or virtual joint of the device could not be kept within its limits:
  /// what the gantry does to a held twin stands above them.
  bool is_blocked() const noexcept;
  /// How far each axis of the gantry may go down and up, the arm held stiff, until a frame other
  /// than the handle, which the law leads, is at a Cartesian limit: by the positions of the last
  /// step, to first order, m or rad.
  void gantry_room(VectorP& down, VectorP& up) const noexcept;

  // of the last step, with its posture:
  /// Twist of the handle as measured, resolved in B.
  Vector6 handle_twist(const RobotState& robot) const noexcept;
  /// Jacobian of the handle, gantry joints first.
  const model::Jacobian& handle_jacobian() const noexcept { return J_H_; }
  /// Twist of the end effector of the twin, resolved in B.
  Vector6 end_effector_twist(const State& state) const noexcept;
  /// Of the twin as set up, at its end effector in the direction of B's axes where it is least, kg.
  double apparent_mass(const State& state) const noexcept;

  /// The budget of a solve from now on, where it is smaller than that of the options; 0: that.
  void limit_solver(std::uint32_t most_active_sets) noexcept;

  /// Who is told about kRenderingSetUp, kSolver and kReactions from now on.
  void watch(const StageProbe& probe) noexcept { ended_ = probe; }

  /// The problem of the last step: rows, bounds and weights.
  const hqp::Problem& problem() const noexcept { return tasks_.problem(); }
  /// Solves that failed, that took options.slow_solve active sets or more, or that keep_problem()
  /// was called for. One other thread may read them.
  const hqp::KeptProblems& kept_problems() const noexcept { return *kept_problems_; }
  /// Keeps the last solve if it belonged to cycle `cycle`; 0 us: not for the time that this took.
  void keep_problem(std::uint64_t cycle, double cycle_time_us = 0.0) noexcept;
  /// s of the last step (11): how H had to accelerate relative to E.
  const Vector6& synchronisation() const noexcept { return tasks_.synchronisation(); }

  /// Moves reference and twin by one period.
  void integrate(State& state) const noexcept;

 private:
  void update_device(const RobotState& robot, const ReferenceState& reference) noexcept;
  Eigen::Vector3d push_of_twin(const Budget& budget) const noexcept;
  void feel_surfaces(State& state, double share, CycleRecord& record) noexcept;
  void give_way(State& state, const CycleRecord& record) const noexcept;
  void solve(State& state, double handle_speed, const GantryTask& gantry,
             CycleRecord& record) noexcept;
  void report_stops(CycleRecord& record) const noexcept;
  void report_kinematics(const State& state, CycleRecord& record) const noexcept;

  DeviceModel device_;
  TwinModel twin_;
  Options options_;
  environment::Environment environment_;
  double stop_rating_;
  Tasks tasks_;
  std::array<environment::Facing, environment::kMostFacing> stops_;  ///< of this cycle
  Reactions reactions_;
  // of this cycle: M_a = L L^T, the Jacobians of handle (gantry first) and end effector
  MatrixA L_;
  model::Jacobian J_H_, J_a_;
  hqp::Options solver_options_;
  hqp::Solver solver_;
  hqp::Solution solution_;
  hqp::ActiveSet guess_;                       ///< that the last solve began with
  std::optional<std::uint64_t> solved_cycle_;  ///< of the last solve
  std::unique_ptr<hqp::KeptProblems> kept_problems_;
  StageProbe ended_;
};

}  // namespace hg::rendering

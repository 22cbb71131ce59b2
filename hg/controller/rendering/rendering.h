/// The rendering law: from the state of device and twin and the user's wrench to
/// accelerations, integrated to the next reference.
///
/// Source: [HG] sec. VI-C; docs/concepts/law.md. One object serves one thread.
/// No allocation, noexcept after construction.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "hg/controller/rendering/law_result.h"
#include "hg/controller/rendering/lost_directions.h"
#include "hg/controller/rendering/options.h"
#include "hg/controller/rendering/reactions.h"
#include "hg/controller/rendering/rendering_state.h"
#include "hg/controller/rendering/surfaces/environment.h"
#include "hg/controller/rendering/tasks.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/core/stage_probe.h"
#include "hg/hqp/problem_capture.h"
#include "hg/hqp/solver.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// Throws SetupError naming the first property of the models that the law cannot use.
void check_rendering(const DeviceModel& device, const TwinModel& twin,
                     const RenderingOptions& options);

class Rendering {
 public:
  Rendering(DeviceModel device, TwinModel twin, const RenderingOptions& options,
            surfaces::Environment environment = {});

  const DeviceModel& device() const noexcept { return device_; }
  const TwinModel& twin() const noexcept { return twin_; }
  /// Device in the posture of the last step(): with M and c only where the law models its motors.
  const model::ChainData& device_chain() const noexcept { return device_now_; }
  /// Twin in the posture of the last step(), with M and c.
  const model::ChainData& twin_chain() const noexcept { return twin_now_; }

  /// State at rest: manipulator at `q_m`, twin at its start.
  RenderingState start(const VectorM& q_m) const noexcept;

  /// Changes a parameter of the twin, from the next step() on.
  ChangeStatus change(const ParameterChange& change, RenderingState& state) const noexcept;

  /// Solves for the accelerations of this sample. Writes all fields of `result`, and the
  /// accelerations to `state`, too; where the law leads the gantry, state.ddq_p. integrate()
  /// advances the state.
  SolverStatus step(const LawInput& input, RenderingState& state, LawResult& result) noexcept;

  /// Whether the law can lead the gantry.
  bool leads_gantry() const noexcept { return tasks_.leads_gantry(); }

  /// Moves the root link of a twin with a moving base, for all that follows.
  void move_base(const TwinBase& base) noexcept;
  /// Moves the resting twin so that its end effector meets the handle, as far as its joints allow.
  void align(const RobotState& robot, RenderingState& state) noexcept;

  /// Keeps the reference within `largest` (rad or m) of the measured joints; [C] 6: reference and
  /// twin move back to a device that lags, so that no error builds up. True when they moved.
  bool clamp_reference(const RobotState& robot, double largest, RenderingState& state) noexcept;

  /// Whether in the last step a joint or virtual joint of the device could not be kept within its
  /// limits: the motion of the gantry at a held twin has priority over them.
  bool is_blocked() const noexcept;
  /// Distance that each gantry axis may move down and up, the arm held stiff, until a frame is at a
  /// Cartesian limit: by the positions of the last step, to first order, m or rad. The handle,
  /// which the law leads, counts only where limits brake together, and there the less the more the
  /// arm can brake it.
  void gantry_room(VectorP& down, VectorP& up) const noexcept;

  /// Twist of the handle at the measured speeds in the posture of the last step(), resolved in B.
  Vector6 handle_twist(const RobotState& robot) const noexcept;
  /// Jacobian of the handle in the posture of the last step(), gantry joints first.
  const model::Jacobian& handle_jacobian() const noexcept { return J_H_; }
  /// Twist of the twin's end effector against its base, and with its joints at rest.
  Vector6 end_effector_twist(const RenderingState& state) const noexcept;
  const Vector6& carried_twist() const noexcept { return carried_twist_; }
  /// Mass of the twin as set up, kg, in the posture of the last step(), along the axis of B where
  /// it is least.
  double apparent_mass(const RenderingState& state) const noexcept;

  /// Installs a callback for the stages kRenderingSetUp, kSolver and kReactions.
  void watch(const StageProbe& probe) noexcept { ended_ = probe; }

  /// The problem of the last step: rows, bounds and weights.
  const hqp::Problem& problem() const noexcept { return tasks_.problem(); }
  /// Kept solves: failed, with options.slow_solve active sets or more, or requested by
  /// keep_problem(). One other thread may read them.
  const hqp::ProblemCapture& kept_problems() const noexcept { return *kept_problems_; }
  /// Keeps the last solve if it belonged to cycle `cycle`; `cycle_time_us` = 0: not kept because of
  /// the time that the cycle took.
  void keep_problem(std::uint64_t cycle, double cycle_time_us = 0.0) noexcept;
  /// Right-hand side s of the last step (11): required acceleration of H relative to E.
  const Vector6& synchronisation() const noexcept { return tasks_.synchronisation(); }

  /// Advances reference and twin by one period.
  void integrate(RenderingState& state) const noexcept;

 private:
  void update_device(const RobotState& robot, const ReferenceState& reference) noexcept;
  void update_twin(const Vector6& w_H, RenderingState& state) noexcept;
  Eigen::Vector3d push_of_twin(const Budget& budget) const noexcept;
  void add_torques(const LawInput& input, bool is_released, RenderingState& state,
                   LawResult& result) const noexcept;
  void feel_surfaces(const LawInput& input, RenderingState& state, LawResult& result) noexcept;
  void slow_lost_directions(bool is_released, const RenderingState& state,
                            LawResult& result) noexcept;
  void give_way(const ContactReport& contact, RenderingState& state) const noexcept;
  void solve(const LawInput& input, RenderingState& state, LawResult& result) noexcept;
  void fill_tasks(const LawInput& input, const VectorA& tau, const RenderingState& state) noexcept;
  void solve_once(const LawInput& input, RenderingState& state, LawResult& result) noexcept;
  bool release(RenderingState& state, Budget& budget) const noexcept;
  void add_stops(ContactReport& contact) const noexcept;
  void to_hand(const RenderingState& state, LawResult& result) const noexcept;
  void find_kinematics(const RenderingState& state, LawResult& result) const noexcept;
  void follow_device(const RobotState& robot, const VectorM& q_m, LawResult& result) const noexcept;

  DeviceModel device_;
  TwinModel twin_;
  model::ChainData device_now_, twin_now_;  ///< Both in the posture of the last update
  RenderingOptions options_;
  double dt_;  ///< Period, s
  surfaces::Environment environment_;
  double stop_rating_;
  Tasks tasks_;
  Stops stops_;  ///< Stops in this cycle
  Reactions reactions_;
  // of this cycle: M_a = L L^T, damping of lost directions included; Jacobians of handle (gantry
  // first) and end effector, and what a moving base adds to its twist
  MatrixA L_;
  LostDirections lost_;
  model::Jacobian J_H_, J_a_;
  Vector6 carried_twist_ = Vector6::Zero();
  hqp::SolverOptions solver_options_;
  hqp::Solver solver_;
  hqp::Solution solution_;
  hqp::ActiveSet guess_;                       ///< Active set from which the last solve started
  std::optional<std::uint64_t> solved_cycle_;  ///< Cycle of the last solve
  std::unique_ptr<hqp::ProblemCapture> kept_problems_;
  StageProbe ended_;
};

}  // namespace hg::rendering

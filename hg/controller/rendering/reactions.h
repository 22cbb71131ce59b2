/// Explains what the user feels: which limits act, how hard, and where the user's wrench goes.
///
/// Law gauss: the total constraint torque M_a ddq_a - tau is unique; its split among the active
/// rows is not when rows depend on each other. Rule: reactions have the sign of their bound, except
/// above a row that could not be met, for whose sake they may be held; with a joint to spare they
/// do not push against its idle motion; among all splits that add up, the smallest one, rows scaled
/// by their rating; rows that could not be met get a share only for what the others cannot explain.
/// Law paper: the constraint torques are part of the solution; what they do not explain is
/// conflict.
///
/// No allocation after construction.
#pragma once

#include <array>
#include <span>

#include "hg/controller/rendering/constraint_directions.h"
#include "hg/controller/rendering/law_result.h"
#include "hg/controller/rendering/tasks.h"
#include "hg/hqp/solver.h"
#include "hg/signals/state.h"

namespace hg::rendering {

class Reactions {
 public:
  /// `stops`: number of rows of virtual surfaces besides the limits of the catalogue.
  Reactions(const DeviceModel& device, const TwinModel& twin, int stops = 0);

  /// Sets the Jacobians of this cycle, see ConstraintDirections; call before split() and report().
  void update(const model::Jacobian& J_H, const model::Jacobian& J_a) noexcept {
    directions_.update(J_H, J_a);
  }
  ConstraintDirections& directions() noexcept { return directions_; }

  /// Splits the constraint torque of `solution`, which solves tasks.problem(), or reads it from x.
  /// `tau_constraint` (n_a) = M_a ddq_a + c_a - tau.
  void split(const Tasks& tasks, const hqp::Solution& solution,
             const VectorA& tau_constraint) noexcept;

  /// Constraint force or torque of a limit in its own coordinate; stop i has the index catalogue
  /// size + i.
  double of(int limit) const noexcept { return value_[limit]; }

  /// Torque of all limits of the device on the twin (n_a).
  VectorA torque_of_device() const noexcept;

  /// What report() needs besides the problem and its solution.
  struct Felt {
    const MatrixA& L;            ///< Cholesky factor of M_a
    const model::Jacobian& J_a;  ///< Jacobian of the twin's end effector
    const Vector6& w;            ///< Wrench of the user on the twin
    double dt;                   ///< Period, s
  };

  /// Fills limits, felt_limit, w_felt and the constraint parts and structure of the budget. Needs
  /// tau_a of `result`, and adds the reactions of stops to its budget.
  void report(const Tasks& tasks, const hqp::Solution& solution, const Felt& felt,
              LawResult& result) const noexcept;

 private:
  /// Limits that may have a reaction.
  std::span<const int> active() const noexcept { return std::span(active_).first(active_count_); }
  void find_active(const Tasks& tasks, const hqp::Solution& solution) noexcept;
  void split_active(const Tasks& tasks, const hqp::Solution& solution,
                    const VectorA& tau_constraint) noexcept;
  void add_signs(const Tasks& tasks, const hqp::Solution& solution) noexcept;
  void add_sum(const VectorA& tau_constraint) noexcept;
  VectorA torque(int limit) const noexcept;
  void report_felt(const MatrixA& L, LawResult& result) const noexcept;

  static constexpr int kMaxReactions = kMaxLimits + kMostStops;

  int n_m_, n_a_, device_limits_;
  int count_;  ///< Number of limits and stops
  std::array<double, kMaxReactions> value_{};
  std::array<int, kMaxReactions> active_{};  ///< See active(); the first active_count_ entries
  int active_count_ = 0;
  std::array<double, kMaxReactions> scale_{};  ///< Scale of active limit j in the split
  /// Torque of active limit j on the twin per unit of the split.
  MatrixUpTo<kMaxTwin, kMaxReactions> columns_;
  /// Torque on the twin of a unit reaction of each stop.
  MatrixUpTo<kMaxTwin, kMostStops> stop_torque_;
  VectorA rest_;  ///< Unexplained part of the constraint torque
  ConstraintDirections directions_;
  hqp::Problem problem_;
  hqp::Solver solver_;
  hqp::Solution solution_;
  hqp::ActiveSet active_set_;
};

}  // namespace hg::rendering

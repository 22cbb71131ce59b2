/// The tasks of the rendering law as one lexicographic problem, refilled every cycle.
///
/// Source: [HG] (9)-(19), Table II, tasks 1-8; options: docs/concepts/law.md.
///
///   law gauss       bounds of the gantry's drives, where the law leads it
///   then            coupling of H and E (12), 6 equalities
///   then            manipulator joints
///   then            virtual joints (singularity)
///   then            torques of the motors, where the law models them; motor_torque.h
///   then            Cartesian limits, a level per frame, then self-collision
///   then            twin joints and locks, virtual surfaces that are stops
///   bounds paper    acceleration ratings of the manipulator joints, then of the twin joints
///   law gauss       L^T ddq_a = L^-1 tau with M_a = L L^T; x = (ddq_m, ddq_a, ddq_p)
///                   aim of the gantry, where the law leads it
///                   inner ranges and posture, where the manipulator has a joint to spare
///   law paper       dynamics, range and norm of the constraint torques; paper_law.h
///
/// Rows have the weight 1 / rating in law gauss, none in law paper. No allocation once set up.
#pragma once

#include <optional>
#include <vector>

#include "hg/controller/rendering/holding.h"
#include "hg/controller/rendering/joint_braking.h"
#include "hg/controller/rendering/options.h"
#include "hg/controller/rendering/paper_law.h"
#include "hg/controller/rendering/stop_path.h"
#include "hg/controller/rendering/stops.h"
#include "hg/controller/rendering/task_input.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"
#include "hg/signals/state.h"

namespace hg::rendering {

/// Acceleration with which the handle brakes before a virtual surface that is a stop: the least of
/// its ratings, m/s^2.
double stop_rating(const DeviceModel& device);

/// Whether accelerations of the gantry are unknowns of the law. Where the law cannot have them, or
/// there is no gantry, a rule leads it, whatever `options` select.
bool leads_gantry(const DeviceModel& device, const RenderingOptions& options) noexcept;

/// Whether limits of the device brake together. Where the law does not model the motors, or bounds
/// do not brake in time, each brakes separately, whatever `options` select.
bool brakes_together(const DeviceModel& device, const RenderingOptions& options) noexcept;

class Tasks {
 public:
  /// `stops`: number of virtual surfaces that can act at a time and must not be entered.
  Tasks(const DeviceModel& device, const TwinModel& twin, const RenderingOptions& options,
        int stops = 0);

  /// Writes all rows. `device` and `twin` are the models given to the constructor.
  void fill(const DeviceModel& device, const TwinModel& twin, const TaskInput& input) noexcept;

  const hqp::Problem& problem() const noexcept { return problem_; }
  const std::vector<LimitRow>& limit_rows() const noexcept { return limit_rows_; }
  int first_limit_row() const noexcept { return coupling_row_ + 6; }
  /// Number of rows of virtual surfaces that are stops; they follow the limits of the catalogue and
  /// are treated alike.
  int stop_count() const noexcept { return stop_count_; }
  /// Number of limit rows from first_limit_row() on: bounds, then acceleration ratings.
  int limit_row_count() const noexcept { return limit_row_count_; }
  /// The row of limit `limit` that acts in `solution`: the first one, unless only another does.
  int acting_row(int limit, const hqp::Solution& solution) const noexcept;
  /// Computes the motor torques of `solution`, which solves problem().
  void find_motor_torques(const hqp::Solution& solution) noexcept;
  /// Motor torques found by find_motor_torques(), Nm or N: n_m, or empty where the law does not
  /// model the motors.
  const VectorM& motor_torque() const noexcept { return motor_torque_; }
  bool leads_gantry() const noexcept { return n_g_ > 0; }  ///< Its accelerations are unknowns
  /// Gantry accelerations demanded by a solution, n_p; only where leads_gantry().
  VectorP gantry_acceleration(const hqp::Solution& solution) const noexcept {
    return Eigen::Map<const Eigen::VectorXd>(solution.x.data() + n_m_ + n_a_, n_g_);
  }
  /// Whether all rows of device limits are in levels that `solution` has completed, or are met to
  /// 1e-6.
  bool keeps_limits_of_device(const hqp::Solution& solution) const noexcept;
  /// Whether all rows of joints and virtual joints are in completed levels or are met to 1e-3
  /// rad/s^2.
  bool keeps_joints(const hqp::Solution& solution) const noexcept;
  /// Limit ends that `solution` touches or exceeds, of both rows of a joint.
  TouchedEnds touched_ends(const hqp::Solution& solution) const noexcept;
  /// Law paper: index of the constraint force or torque of a limit in x; law gauss: -1.
  int alpha(int limit) const noexcept { return paper_ ? paper_->alpha(limit) : -1; }
  /// Factor by which the device can brake harder than needed before all its limits together, in
  /// this cycle; kMostReserve: at least, or nothing is near, or limits brake alone.
  double braking_reserve() const noexcept { return braking_reserve_; }
  /// Right-hand side (11) of the coupling: required acceleration of H relative to E.
  const Vector6& synchronisation() const noexcept { return s_; }

 private:
  void add_levels(const DeviceModel& device, const TwinModel& twin);
  void add_device_limits(const DeviceModel& device);
  void add_twin_limits(const DeviceModel& device, const TwinModel& twin);
  void add_gauss(const DeviceModel& device);
  void add_limit(const limits::JointLimits& limits, int variable, double margin);
  void add_rating(int limit, int variable);
  double weight_of(const LimitRow& row) const noexcept;
  void fill_coupling(const DeviceModel& device, const TwinModel& twin,
                     const TaskInput& input) noexcept;
  void fill_device_limits(const DeviceModel& device, const TaskInput& input) noexcept;
  void fill_motors(const DeviceModel& device, const TaskInput& input) noexcept;
  void brake_together() noexcept;
  void keep_holding(const DeviceModel& device, const TaskInput& input) noexcept;
  void stop_inside(const DeviceModel& device, const TaskInput& input) noexcept;
  void keep_apart(const DeviceModel& device, const CollisionTask& task) noexcept;
  void fill_twin_limits(const TwinModel& twin, const TaskInput& input) noexcept;
  bool keeps(const hqp::Solution& solution, int count, double tolerance) const noexcept;
  void fill_gantry(const TaskInput& input) noexcept;
  void fill_stops(const TaskInput& input) noexcept;
  void fill_dynamics(const MatrixA& L, const VectorA& tau) noexcept;
  void add_posture(const DeviceModel& device);
  void fill_posture(const DeviceModel& device, const TaskInput& input) noexcept;
  void fill_ranges(const TaskInput& input) noexcept;
  void set_limit(int limit, const limits::JointLimits& limits, double q, double dq,
                 double known_acceleration) noexcept;
  void hold(int limit, double ddq) noexcept;

  RenderingOptions options_;
  double dt_;  ///< Period, s
  int n_m_, n_a_;
  int n_g_;  ///< Gantry axes that the law leads
  int stop_count_;
  bool has_torques_;
  bool are_torques_known_ = false;  ///< Motor torques are known in this cycle
  int first_motor_;                 ///< Index of the first motor limit
  int limit_row_count_ = 0;
  int coupling_row_ = 0;  ///< first row of (12)
  int dynamics_row_ = 0;  ///< first row of Gauss' principle
  int posture_row_ = 0;   ///< first row of the posture of seven joints, its inner ranges first
  hqp::Problem problem_;
  std::vector<LimitRow> limit_rows_;
  struct InnerRange {
    limits::JointLimits limits;
    limits::RecoverableOptions options;
  };
  std::vector<InnerRange> inner_;     ///< Ranges in which a joint to spare keeps the joints
  std::vector<double> coefficients_;  ///< scratch, one row
  Vector6 s_ = Vector6::Zero();
  VectorP ddq_p_;         ///< Gantry acceleration in this cycle, without the unknowns
  VectorM known_torque_;  ///< Motor torques in this cycle, without those that accelerate the joints
  VectorM motor_torque_;
  std::optional<JointBraking> joint_braking_;  ///< only where limits brake together
  std::vector<int> braking_;          ///< Limits that brake together: the device's, the twin's
  std::vector<Approach> approaches_;  ///< Their approaches in this cycle
  std::vector<Interval> lasting_, joint_room_;  ///< Of motors once reached; of joints up to walls
  double braking_reserve_ = kMostReserve;
  std::optional<Holding> holding_;     ///< only where limits brake together
  std::optional<StopPath> stop_path_;  ///< the same; of its walls without gantry only
  std::optional<PaperLaw> paper_;      ///< law paper only
};

}  // namespace hg::rendering

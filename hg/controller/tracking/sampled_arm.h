/// Parts shared by all linear models of the torque loop, from sample to sample: the arm between
/// commands and encoders, the arrival of commands, the observers, and the controller at rest.
///
/// SI units; set-up only.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hg/controller/tracking/loop_stability.h"

namespace hg::tracking {

/// Steps of the plant per period: latencies are rounded to them.
inline constexpr int kPlantSteps = 8;

/// Rate of change of (theta, theta', q, q', current) under constant torque commands: a square
/// matrix of 6 n rows whose last n columns are those of the commands (its last n rows are 0). `M`
/// is the mass matrix of the links (n x n, kg m^2).
Eigen::MatrixXd plant_with_input(const TruePlant& plant, const MatrixM& M);

/// Delay with which torque commands arrive at the motors.
class DiscreteDelay {
 public:
  DiscreteDelay(double latency_s, double period_s);

  /// Number of earlier commands still under way at a sample.
  int slots() const { return (steps_ + kPlantSteps - 1) / kPlantSteps; }
  /// Age in periods of the command at work in step `step` (0..kPlantSteps - 1) of a period; 0 =
  /// given at the beginning of this one.
  int age(int step) const;

 private:
  int steps_;
};

/// The observers of motors and links as part of a linear state: theta of the last sample, filtered
/// theta', observed q, observed q' (n values each).
class LinearObservers {
 public:
  LinearObservers(const LoopFilters& filters, double period_s);

  /// Updates `observed` (4 n values) with encoder positions `theta` and `q`, given the link
  /// accelerations `ddq` that the observers assume.
  void advance(const Eigen::VectorXd& theta, const Eigen::VectorXd& q, const Eigen::VectorXd& ddq,
               Eigen::Ref<Eigen::VectorXd> observed) const;

 private:
  double dt_, motor_pole_, link_pole_;  // poles from sample to sample
};

/// State of a robot at rest in posture `q` (gantry first), its springs carrying `weight` (Nm).
RobotState standing(const std::vector<ActuatorModel>& actuators, const Eigen::VectorXd& q,
                    const VectorM& weight);
/// Reference followed by a robot at rest.
ReferenceState standing_reference(const RobotState& robot);

}  // namespace hg::tracking

/// True behaviour of a simulated device, compared with its controller's estimate: errors of the
/// links, distance of handle and twin, limits, torques, forces and vibration at the handle.
///
/// Computed from samples whose truth is known, outside the control loop. Limits are evaluated in
/// every mode, joints while running or stopping, and felt quantities while running.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hg/signals/state.h"

namespace hg::analysis {

/// Second-order Butterworth high-pass of a vector, sampled at `rate_Hz`.
class HighPass {
 public:
  HighPass(double cutoff_Hz, double rate_Hz) noexcept;
  Eigen::Vector3d step(const Eigen::Vector3d& value) noexcept;

 private:
  double b_, a1_, a2_;  // coefficients of y = b (x - 2 x1 + x2) - a1 y1 - a2 y2
  Eigen::Vector3d x1_, x2_, y1_, y2_;
  bool is_started_ = false;
};

/// Positions of all limits of the device in the order of its catalogue.
using FindPositions = std::function<void(const Truth&, std::vector<double>&)>;

class TruthSummary {
 public:
  /// `catalogue` begins with the limits of the device. `torque_rated`: rated motor torques, Nm;
  /// empty for a device without torque control.
  TruthSummary(const LimitCatalogue& catalogue, FindPositions positions, double rate_Hz,
               const VectorM& torque_rated = {});

  void add(const Sample& sample);

  bool is_known() const noexcept { return cycles_ > 0; }
  /// Largest true excess over each limit of the device, >= 0.
  const std::vector<double>& worst_excess() const noexcept { return worst_excess_; }
  /// Largest difference of reference and true link, rad or m, and its joint.
  double max_joint_error() const noexcept { return max_joint_error_; }
  int worst_joint() const noexcept { return worst_joint_; }
  /// Largest loads on a bystander, each separately.
  const BystanderReport& bystander() const noexcept { return bystander_; }
  /// Largest distance of the true handle and the twin's end effector, m.
  double max_hand_distance() const noexcept { return max_hand_distance_; }
  /// Largest motor torque over its peak, per joint; empty without torque control.
  const VectorM& max_torque_share() const noexcept { return max_torque_share_; }
  /// rms of the true motor torque over the motor's rated torque, per joint; above 1 it would
  /// overheat. Empty without torque control.
  VectorM rated_torque_share() const;
  std::uint64_t clamped_cycles() const noexcept { return clamped_cycles_; }
  /// Mean true force of the user on the handle, N.
  double mean_force() const noexcept;
  /// rms of the true acceleration of the handle above 5 and 20 Hz, m/s^2.
  double vibration() const noexcept { return rms(sum_vibration_); }
  double vibration_20() const noexcept { return rms(sum_vibration_20_); }

 private:
  double rms(double sum_of_squares) const noexcept;

  std::vector<Interval> ranges_;
  FindPositions positions_of_;
  std::vector<double> positions_, worst_excess_;
  HighPass above_5_, above_20_;
  std::uint64_t cycles_ = 0, clamped_cycles_ = 0;
  double max_joint_error_ = 0.0, max_hand_distance_ = 0.0;
  int worst_joint_ = -1;
  VectorM max_torque_share_, torque_rated_, sum_torque_;
  BystanderReport bystander_;
  double sum_force_ = 0.0, sum_vibration_ = 0.0, sum_vibration_20_ = 0.0;
};

}  // namespace hg::analysis

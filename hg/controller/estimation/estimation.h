/// From sensors to state: joints, gantry motion, user wrench at the handle.
///
/// Sources: [C] 2, [HANDBOOK] 1.5, 1.6. What a device does not measure is not estimated: without
/// motor-side encoders (ideal position-controlled devices) joints are taken as measured.
/// No allocation, noexcept after set-up.
#pragma once

#include <array>
#include <cstdint>

#include "hg/controller/estimation/estimation_config.h"
#include "hg/controller/estimation/gantry_observer.h"
#include "hg/controller/estimation/inertial_check.h"
#include "hg/controller/estimation/inertial_units.h"
#include "hg/controller/estimation/joint_observer.h"
#include "hg/controller/estimation/rest_watch.h"
#include "hg/controller/estimation/user_wrench.h"
#include "hg/core/types.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"
#include "hg/signals/state.h"

namespace hg::estimation {

struct EstimationState {
  bool is_started = false;
  std::array<GantryObserver, kMaxGantry> gantry;
  VectorM q_m;  ///< unwrapped joints of the last sample
  std::array<LinkObserver, kMaxManipulator> link;
  std::array<MotorObserver, kMaxManipulator> motor;
  WrenchState wrench;
  RestState rest;
  InertialCheck inertial;
  InertialUnitsState units;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const EstimationState& state) {
  const auto& [is_started, gantry, q_m, link, motor, wrench, rest, inertial, units] = state;
  for (const GantryObserver& axis : gantry) hash.mix(axis);
  hash.mix(q_m);
  for (int i = 0; i < q_m.size(); ++i) {
    hash.mix(link[i].q, link[i].dq, motor[i].theta, motor[i].dtheta);
  }
  hash.mix(std::uint64_t{is_started} | std::uint64_t{wrench.is_started} << 1U, wrench, inertial);
  if (units.is_started) hash.mix(units);
  hash.mix(rest);
}

class Estimation {
 public:
  Estimation(const EstimationConfig& config, const DeviceModel& device);

  /// Estimates the state of a sample. `dq_p_cmd` is the gantry command that was sent in the last
  /// cycle (n_p), `ddq_m_reference` the acceleration of the manipulator's reference since then
  /// (n_m).
  RobotState step(const SensorFrame& sensors, const VectorP& dq_p_cmd,
                  const VectorM& ddq_m_reference, EstimationState& state) noexcept;

  /// Compares inertial unit and encoders, after step(); no effect without a unit. `is_on`: the
  /// drives have power.
  void check_motion(const SensorFrame& sensors, bool is_on, EstimationState& state) const noexcept;

  /// Looks for drift of the wrench's zero, after step(), from whose next call on it counts. `input`
  /// has what the twin and the handle do; the rest is found here.
  void watch_rest(RestInput input, EstimationState& state) const noexcept;

  /// Starts a tare of the wrench when requested, unless one is under way; ends a running one unless
  /// the device is at rest.
  void tare(bool is_asked_for, bool is_at_rest, EstimationState& state) const noexcept;
  /// Whether the wrench is tared, or the device needs no tare for running.
  bool is_tared(const EstimationState& state) const noexcept {
    return state.wrench.tare.is_valid || !config_.wrench.tare.is_needed;
  }
  bool has_units() const noexcept { return units_.has_any(); }
  /// Report of the units on the links; empty without.
  InertialReport inertial_report(const EstimationState& state) const noexcept {
    return units_.report(state.units);
  }
  /// Acceleration of the gantry not commanded to its drives, n_p, m/s^2 or rad/s^2.
  VectorP gantry_disturbance(const EstimationState& state) const noexcept;

 private:
  bool turns_without_end(int joint) const noexcept;
  double unwrapped(int joint, double measured, double last) const noexcept;
  void start(const SensorFrame& sensors, EstimationState& state) const noexcept;
  VectorM observe_joints(const SensorFrame& sensors, const VectorM& ddq_m_reference,
                         EstimationState& state, RobotState& robot) const noexcept;
  VectorP observe_gantry(const SensorFrame& sensors, const VectorP& dq_p_cmd,
                         EstimationState& state, RobotState& robot) const noexcept;
  void take_tare(const SensorFrame& sensors, const Eigen::Matrix3d& R_B_S, const RobotState& robot,
                 EstimationState& state) const noexcept;
  void observe_wrench(const SensorFrame& sensors, EstimationState& state,
                      RobotState& robot) noexcept;

  EstimationConfig config_;
  model::ChainData chain_;
  int n_p_, n_m_, handle_;
  double dt_;  ///< Period, s
  Pose T_H_S_;
  DriveModel drive_;
  int dead_periods_;
  GantryGains gantry_gains_;
  double link_pole_, motor_pole_;
  InertialUnits units_;
};

}  // namespace hg::estimation

#include "hg/safety/monitor.h"

#include <algorithm>
#include <cmath>

namespace hg::safety {
namespace {

template <typename Vector>
int first_not_finite(const Vector& v) noexcept {
  for (int i = 0; i < v.size(); ++i) {
    if (!std::isfinite(v[i])) return i;
  }
  return -1;
}

Fault make_fault(FaultCode code, int index, double value, double limit) noexcept {
  return {code, static_cast<std::int16_t>(index), value, limit};
}

// The first of several vectors' components that is not finite, counted through; -1 = none.
template <typename... Vectors>
int first_of_all(const Vectors&... vectors) noexcept {
  int first = 0, found = -1;
  const auto look = [&](const auto& v) {
    const int i = first_not_finite(v);
    if (found < 0 && i >= 0) found = first + i;
    first += static_cast<int>(v.size());
  };
  (look(vectors), ...);
  return found;
}

// joints, joint speeds, gantry, wrench, motors, joint torques, accelerometer, gyroscope
int first_not_finite(const MonitorConfig& config, const SensorFrame& sensors) noexcept {
  const Eigen::Vector3d kNone = Eigen::Vector3d::Zero();
  return first_of_all(sensors.q_m, sensors.dq_m, sensors.q_p, sensors.w_S, sensors.theta_m,
                      sensors.tau_m, config.has_imu ? sensors.a_S : kNone,
                      config.has_imu ? sensors.omega_S : kNone);
}

}  // namespace

bool is_finite(const MonitorConfig& config, const SensorFrame& sensors) noexcept {
  return first_not_finite(config, sensors) < 0;
}

Fault check_sensors(const MonitorConfig& config, const SensorFrame& sensors,
                    std::uint64_t expected_sequence) noexcept {
  if (sensors.driver_fault != FaultCode::kNone) {
    return make_fault(sensors.driver_fault, -1, 0.0, 0.0);
  }
  if (sensors.sequence != expected_sequence) {
    return make_fault(FaultCode::kSequenceGap, -1, static_cast<double>(sensors.sequence),
                      static_cast<double>(expected_sequence));
  }

  const int index = first_not_finite(config, sensors);
  if (index >= 0) return make_fault(FaultCode::kSensorNotFinite, index, NAN, 0.0);

  const double force = sensors.w_S.head<3>().norm();
  if (force > config.force_max) {
    return make_fault(FaultCode::kWrenchTooLarge, 0, force, config.force_max);
  }
  const double torque = sensors.w_S.tail<3>().norm();
  if (torque > config.torque_max) {
    return make_fault(FaultCode::kWrenchTooLarge, 1, torque, config.torque_max);
  }
  return {};
}

Fault check_solution(const CycleRecord& record) noexcept {
  if (record.solver_status != SolverStatus::kSolved) {
    return make_fault(FaultCode::kSolverFailed, -1, static_cast<double>(record.solver_status), 0.0);
  }
  const ReferenceState& reference = record.reference;
  int index = first_not_finite(reference.ddq_m);
  if (index < 0) index = first_not_finite(record.twin.ddq_a);
  if (index >= 0) return make_fault(FaultCode::kReferenceNotFinite, index, NAN, 0.0);
  return {};
}

Fault check_reference(const MonitorConfig& config, const CycleRecord& record) noexcept {
  const ReferenceState& reference = record.reference;
  for (int i = 0; i < reference.q_m.size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const Interval range = config.joint_range[joint];
    const bool is_slide = !config.is_slide.empty() && config.is_slide[joint];
    const double beyond = is_slide ? config.slide_tolerance : config.position_tolerance;
    const double apart = is_slide ? config.slide_tracking_tolerance : config.tracking_tolerance;
    const double nearest = std::clamp(reference.q_m[i], range.lb, range.ub);
    if (std::abs(reference.q_m[i] - nearest) > beyond) {
      return make_fault(FaultCode::kLimitExceeded, i, reference.q_m[i], nearest);
    }
    const double fastest = config.speed_tolerance * config.joint_speed_max[joint];
    if (std::abs(reference.dq_m[i]) > fastest) {
      return make_fault(FaultCode::kSpeedExceeded, i, reference.dq_m[i], fastest);
    }
    const double error = std::abs(reference.q_m[i] - record.robot.q_m[i]);
    if (error > apart) return make_fault(FaultCode::kTrackingLost, i, error, apart);
  }
  for (int i = config.first_cartesian; i < config.end_cartesian; ++i) {
    const double excess = record.limits[static_cast<std::size_t>(i)].excess;
    if (excess > config.cartesian_tolerance) {
      return make_fault(FaultCode::kLimitExceeded, i, excess, config.cartesian_tolerance);
    }
  }
  if (record.sync_error > config.sync_tolerance) {
    return make_fault(FaultCode::kSyncLost, -1, record.sync_error, config.sync_tolerance);
  }
  return {};
}

Fault sanitise(const MonitorConfig& config, CommandFrame& command) noexcept {
  const int index =
      first_of_all(command.q_m, command.dq_m, command.ddq_m, command.tau_m, command.dq_p);
  if (index >= 0) {
    command.enable = false;
    command.dq_m.setZero();
    command.ddq_m.setZero();
    command.tau_m.setZero();
    command.dq_p.setZero();
    for (double& q : command.q_m) q = std::isfinite(q) ? q : 0.0;
    return make_fault(FaultCode::kCommandNotFinite, index, NAN, 0.0);
  }
  for (double& dq : command.dq_p) {
    dq = std::clamp(dq, -config.gantry_speed_max, config.gantry_speed_max);
  }
  return {};
}

}  // namespace hg::safety

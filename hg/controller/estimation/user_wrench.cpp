#include "hg/controller/estimation/user_wrench.h"

#include "hg/controller/estimation/low_pass.h"

namespace hg::estimation {
namespace {

// Acceleration of S minus gravity, resolved in S; without accelerometer as if it stood still.
Eigen::Vector3d acceleration(const WrenchConfig& config, const SensorFrame& sensors,
                             const Eigen::Matrix3d& R_B_S) noexcept {
  constexpr double kGravity = 9.81;  // as in the model of the device
  if (config.has_imu) return sensors.a_S;
  return kGravity * R_B_S.row(2).transpose();
}

}  // namespace

double wrench_delay(const WrenchConfig& config, double dt) noexcept {
  return low_pass_delay(low_pass_pole(config.low_pass_Hz, dt), dt);
}

Vector6 without_weight(const WrenchConfig& config, const SensorFrame& sensors,
                       const Eigen::Matrix3d& R_B_S) noexcept {
  const Eigen::Vector3d at_rest = Eigen::Vector3d::Zero();
  return sensors.w_S -
         payload_wrench(config.payload, acceleration(config, sensors, R_B_S), at_rest, at_rest);
}

void estimate(const WrenchConfig& config, double dt, const SensorFrame& sensors,
              const Eigen::Matrix3d& R_B_S, WrenchState& state) noexcept {
  const bool is_first = !state.is_started;
  Eigen::Vector3d omega_S = Eigen::Vector3d::Zero();
  if (config.has_imu) {
    omega_S = sensors.omega_S;
    const Eigen::Vector3d last = is_first ? omega_S : state.omega_S;
    low_pass(low_pass_pole(config.alpha_low_pass_Hz, dt), (omega_S - last) / dt, state.alpha_S);
    state.omega_S = omega_S;
  }

  const Vector6 w_S =
      sensors.w_S -
      payload_wrench(config.payload, acceleration(config, sensors, R_B_S), omega_S, state.alpha_S) -
      state.tare.offset;
  low_pass(is_first ? 0.0 : low_pass_pole(config.low_pass_Hz, dt), w_S, state.w_S);
  state.is_started = true;
}

}  // namespace hg::estimation

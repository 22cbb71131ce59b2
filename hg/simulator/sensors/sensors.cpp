#include "hg/simulator/sensors/sensors.h"

#include <cmath>
#include <numbers>

namespace hg::simulator {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double wrapped(double q) noexcept { return q - kTurn * std::floor((q + std::numbers::pi) / kTurn); }

SensorFilterConfig no_filter() { return {.average = 0.0, .delay = 0.0}; }

}  // namespace

SensorsConfig ideal_sensors() {
  SensorsConfig config;
  config.link_encoder = config.motor_encoder = config.gantry_encoder = {};
  config.has_differenced_velocity = false;
  config.torque = {.noise = 0.0,
                   .gain_error = 0.0,
                   .offset = 0.0,
                   .ripple = 0.0,
                   .range = kInfinity,
                   .resolution = 0.0};
  config.wrench = {.force_noise = 0.0,
                   .torque_noise = 0.0,
                   .gain_error = 0.0,
                   .shunt = 0.0,
                   .cross_talk = 0.0,
                   .bias = 0.0,
                   .bias_walk = 0.0,
                   .temperature_drift = 0.0,
                   .range = kInfinity,
                   .resolution = 0.0,
                   .filter = no_filter()};
  config.accelerometer = config.gyroscope = {};
  config.imu_filter = no_filter();
  config.link_unit.accelerometer = config.link_unit.gyroscope = {};
  return config;
}

PerfectSensors perfect_sensors(const SensorsConfig& config, bool is_motor_side) noexcept {
  const EncoderConfig& encoder = is_motor_side ? config.motor_encoder : config.link_encoder;
  const WrenchSensorConfig& wrench = config.wrench;
  return {.encoders = encoder.resolution + encoder.offset + encoder.error_1 + encoder.error_2 == 0,
          .wrench = !config.torque_estimate.is_used &&
                    wrench.force_noise + wrench.torque_noise + wrench.bias == 0};
}

Sensors::Sensors(const SensorsConfig& config, const SensedDevice& device)
    : config_(config),
      device_(device),
      wrench_sensor_(config.wrench, device.step, device.period, config.seed),
      accelerometer_(config.accelerometer, config.imu_filter, device.step, device.period,
                     config.seed,
                     {RandomEffect::kAccelerometerNoise, RandomEffect::kAccelerometerErrors,
                      RandomEffect::kAccelerometerDrift}),
      gyroscope_(config.gyroscope, config.imu_filter, device.step, device.period, config.seed,
                 {RandomEffect::kGyroscopeNoise, RandomEffect::kGyroscopeErrors,
                  RandomEffect::kGyroscopeDrift}),
      temperature_(config.temperature, device.period,
                   RandomStream(config.seed, RandomEffect::kTemperature)) {
  const std::uint64_t seed = config.seed;
  for (int unit = 0; unit < device.link_units; ++unit) {
    units_.emplace_back(config.link_unit, device.step, device.period, seed, unit);
  }
  for (Eigen::Index i = 0; i < device.gear_ratio.size(); ++i) {
    const int joint = static_cast<int>(i);
    const double ratio = device.gear_ratio[i];
    link_encoders_[i] =
        Encoder(config.link_encoder, 1.0, RandomStream(seed, RandomEffect::kLinkEncoder, joint));
    motor_encoders_[i] = Encoder(config.motor_encoder, ratio,
                                 RandomStream(seed, RandomEffect::kMotorEncoder, joint));
    torque_sensors_[i] = TorqueSensor(config.torque, device.torque_full_scale[i], ratio,
                                      RandomStream(seed, RandomEffect::kTorqueErrors, joint),
                                      RandomStream(seed, RandomEffect::kTorqueNoise, joint));
  }
  for (Eigen::Index i = 0; i < device.torque_rated.size(); ++i) {
    motor_heat_[i] = MotorHeat(config.motor_heat, device.torque_rated[i], device.period);
  }
  for (int axis = 0; axis < kMaxGantry; ++axis)
    gantry_encoders_[axis] =
        Encoder(config.gantry_encoder, 1.0, RandomStream(seed, RandomEffect::kGantryEncoder, axis));
}

void Sensors::observe(const Truth& truth) noexcept {
  const Eigen::Matrix3d R_S_B = (truth.T_B_H.R * device_.T_H_S.R).transpose();
  const Eigen::Vector3d p_H_S_in_S = device_.T_H_S.R.transpose() * device_.T_H_S.p;
  const auto [a_S, omega_S, alpha_S] =
      felt_at(device_.T_H_S, {truth.T_B_H.R, truth.twist, truth.acceleration});

  const Eigen::Vector3d f = R_S_B * truth.w_H.head<3>();
  Vector6 w_S = payload_wrench(device_.payload, a_S, omega_S, alpha_S);
  w_S.head<3>() += f;
  w_S.tail<3>() += R_S_B * truth.w_H.tail<3>() - p_H_S_in_S.cross(f);

  wrench_sensor_.observe(w_S);
  accelerometer_.observe(a_S);
  gyroscope_.observe(omega_S);
}

void Sensors::sample(const Truth& truth, SensorFrame& frame) noexcept {
  frame.time_s = static_cast<double>(samples_) * device_.period;
  sample_joints(truth, frame);

  frame.q_p.resize(truth.q_p.size());
  for (Eigen::Index i = 0; i < truth.q_p.size(); ++i)
    frame.q_p[i] = gantry_encoders_[i].reading(truth.q_p[i]);

  const double warmer = temperature_.next();
  frame.w_S = wrench_sensor_.sample(warmer);
  frame.a_S = accelerometer_.sample(warmer);
  frame.omega_S = gyroscope_.sample(warmer);
  frame.inertial.resize(6 * static_cast<Eigen::Index>(units_.size()));
  for (std::size_t unit = 0; unit < units_.size(); ++unit) {
    frame.inertial.segment<6>(6 * static_cast<Eigen::Index>(unit)) = units_[unit].sample(warmer);
  }
  ++samples_;
}

void Sensors::sample_joints(const Truth& truth, SensorFrame& frame) noexcept {
  const Eigen::Index n = truth.q_m.size();
  frame.q_m.resize(n);
  frame.dq_m.resize(n);
  const bool is_motor_side = device_.has_position_drives;
  frame.theta_m.resize(is_motor_side ? 0 : truth.theta_m.size());
  frame.tau_m.resize(is_motor_side ? 0 : truth.tau_J.size());
  q_m_before_.conservativeResize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto reported = [&](double q) { return device_.is_endless[i] ? wrapped(q) : q; };
    const double q = is_motor_side ? motor_encoders_[i].reading(truth.theta_m[i])
                                   : link_encoders_[i].reading(truth.q_m[i]);
    const double dq = is_motor_side ? truth.dtheta_m[i] : truth.dq_m[i];
    const double before = samples_ == 0 ? q : q_m_before_[i];
    q_m_before_[i] = q;
    frame.q_m[i] = reported(q);
    frame.dq_m[i] = config_.has_differenced_velocity ? (q - before) / device_.period : dq;
    if (i < frame.theta_m.size())
      frame.theta_m[i] = reported(motor_encoders_[i].reading(truth.theta_m[i]));
    if (i < frame.tau_m.size())
      frame.tau_m[i] = torque_sensors_[i].sample(
          truth.tau_J[i], i < truth.theta_m.size() ? truth.theta_m[i] : truth.q_m[i]);
  }
  const bool has_heat = device_.torque_rated.size() == truth.tau_motor.size();
  frame.temperature_m.resize(has_heat ? truth.tau_motor.size() : 0);
  for (Eigen::Index i = 0; i < frame.temperature_m.size(); ++i) {
    frame.temperature_m[i] = motor_heat_[i].next(truth.tau_motor[i]);
  }
}

}  // namespace hg::simulator

#include "hg/controller/estimation/inertial_check.h"

#include <cmath>
#include <numbers>

#include "hg/core/rotation.h"

namespace hg::estimation {
namespace {

constexpr double kMemory_s = 4.0;  // time constant of forgetting a turn, with power
// the same without power; also for learning zero and gravity
constexpr double kMemoryAtRest_s = 0.5;
constexpr double kMostBias = 0.03;        // rad/s; more is no zero but a drift
constexpr double kSlipMemory_s = 0.5;     // time constant of forgetting a difference of speeds
constexpr double kOffsetMemory_s = 2.0;   // time constant of learning the zero of the accelerometer
constexpr double kMostOffset = 1.0;       // m/s^2: 0.1 rad off level; more is no zero
constexpr double kTypicalGravity = 9.81;  // m/s^2

}  // namespace

void advance(double dt, const InertialSample& sample, bool is_on, InertialCheck& check) noexcept {
  const auto& [R_B_S, p_S, omega_S, a_S] = sample;
  if (!check.is_started) {
    check.is_started = true;
    check.R_B_S = R_B_S;
    check.p_S = p_S;
    check.up_S = a_S;
    return;
  }
  const Eigen::Vector3d by_encoders = R_B_S.transpose() * rotation_between(check.R_B_S, R_B_S);
  check.R_B_S = R_B_S;
  const double kept = 1.0 - dt / (is_on ? kMemory_s : kMemoryAtRest_s);
  check.turn = kept * check.turn + dt * (omega_S - check.bias) - by_encoders;
  check.turned = kept * check.turned + by_encoders;
  check.turned_in_all = kept * check.turned_in_all + by_encoders.norm();

  const Eigen::Vector3d gravity(0.0, 0.0, kTypicalGravity);
  const Eigen::Vector3d v_S = (p_S - check.p_S) / dt;
  check.slip = (1.0 - dt / kSlipMemory_s) * check.slip +
               dt * (R_B_S * (a_S - check.offset_S) - gravity) - (v_S - check.v_S);
  check.offset_S += dt / (kOffsetMemory_s * kSlipMemory_s) * (R_B_S.transpose() * check.slip);
  check.p_S = p_S;
  check.v_S = v_S;
  if (is_on) {
    check.gravity_samples = 0;
    return;
  }
  const auto newest = [dt](int& samples) {
    if (samples * dt < kMemoryAtRest_s) ++samples;
    return 1.0 / samples;
  };
  check.bias += newest(check.rest_samples) * (omega_S - by_encoders / dt - check.bias);
  check.bias = check.bias.cwiseMax(-kMostBias).cwiseMin(kMostBias);
  check.up_S += newest(check.gravity_samples) * (a_S - check.up_S);
  check.offset_S = check.up_S - R_B_S.transpose() * gravity;
  check.offset_S = check.offset_S.cwiseMax(-kMostOffset).cwiseMin(kMostOffset);
  check.offset_at_rest = check.offset_S.norm();
}

double turn_uncertainty(const InertialCheck& check) noexcept {
  constexpr double kScale = 0.015, kOther = 0.003;
  return kScale * check.turned.norm() + kOther * check.turned_in_all;
}

double slip_uncertainty(const InertialCheck& check) noexcept {
  constexpr double kOwn = 0.2;      // m/s^2
  constexpr double kPeak_s = 0.74;  // of `slip` after a step of 2 m/s^2, with both memories
  return kPeak_s * std::fmax(0.0, check.offset_at_rest - kOwn);
}

double tilt(const InertialCheck& check) noexcept {
  if (!check.is_started) return 0.0;
  if (check.up_S.norm() < 0.5 * kTypicalGravity) return std::numbers::pi;
  const double rise = check.R_B_S.row(2).dot(check.up_S) / check.up_S.norm();
  return std::acos(std::fmin(1.0, std::fmax(-1.0, rise)));
}

}  // namespace hg::estimation

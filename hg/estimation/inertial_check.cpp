#include "hg/estimation/inertial_check.h"

#include <cmath>

#include "hg/core/rotation.h"

namespace hg::estimation {
namespace {

constexpr double kMemory_s = 4.0;         // with power, after which a turn is forgotten
constexpr double kMemoryAtRest_s = 0.5;   // without, in which zero and gravity are learnt
constexpr double kMostBias = 0.03;        // rad/s; more is no zero but a drift
constexpr double kTypicalGravity = 9.81;  // m/s^2

}  // namespace

void advance(double dt, const Eigen::Matrix3d& R_B_S, const Eigen::Vector3d& omega_S,
             const Eigen::Vector3d& a_S, bool is_on, InertialCheck& check) noexcept {
  if (!check.is_started) {
    check.is_started = true;
    check.R_B_S = R_B_S;
    check.up_S = a_S;
    return;
  }
  const Eigen::Vector3d by_encoders = R_B_S.transpose() * rotation_between(check.R_B_S, R_B_S);
  check.R_B_S = R_B_S;
  const double kept = 1.0 - dt / (is_on ? kMemory_s : kMemoryAtRest_s);
  check.turn = kept * check.turn + dt * (omega_S - check.bias) - by_encoders;
  check.turned = kept * check.turned + by_encoders.norm();
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
}

double tilt(const InertialCheck& check) noexcept {
  if (check.up_S.norm() < 0.5 * kTypicalGravity) return 0.0;
  const double rise = check.R_B_S.row(2).dot(check.up_S) / check.up_S.norm();
  return std::acos(std::fmin(1.0, std::fmax(-1.0, rise)));
}

}  // namespace hg::estimation

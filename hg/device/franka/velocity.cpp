#include "hg/device/franka/velocity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hg/device/franka/protocol.h"

namespace hg::franka {
namespace {

constexpr double kGain = 10.0;  // 1/s [A]

// Limits of an FR3: libfranka 0.21, include/franka/rate_limiting.h. Differs from it: 1 % less of
// acceleration and jerk, since a state has only floats of the last values.
constexpr double kTolerance = 1e-3;    // rad/s
constexpr double kAcceleration = 9.9;  // rad/s^2
constexpr double kJerk = 4950.0;       // rad/s^3

// A speed of at most `most`, and of sqrt(`slope` * distance to the end) - `offset`.
struct SpeedLimit {
  double most, offset, slope, q_max, q_min;
};

constexpr std::array<SpeedLimit, kJoints> kSpeedLimits = {{{2.62, 0.30, 12.0, 2.7501, -2.7501},
                                                           {2.62, 0.20, 5.17, 1.7918, -1.7918},
                                                           {2.62, 0.20, 7.0, 2.9065, -2.9065},
                                                           {2.62, 0.30, 8.0, -0.1458, -3.0481},
                                                           {5.26, 0.35, 34.0, 2.8101, -2.8101},
                                                           {4.18, 0.35, 11.0, 4.5205, 0.54092},
                                                           {5.26, 0.35, 34.0, 3.0196, -3.0196}}};

double most_at(const SpeedLimit& limit, double distance) noexcept {
  const double towards_end = std::sqrt(limit.slope * std::max(0.0, distance)) - limit.offset;
  return std::clamp(towards_end, 0.0, limit.most) - kTolerance;
}

// Differs from limitRate() of libfranka in nothing but its numbers: near the largest speed the
// acceleration falls with the speed that is left, so that its end needs no more jerk.
double limited_speed(double wanted, double lower, double upper, double last,
                     double last_acceleration) noexcept {
  const double jerk = ((wanted - last) / kPeriod_s - last_acceleration) / kPeriod_s;
  const double acceleration = last_acceleration + std::clamp(jerk, -kJerk, kJerk) * kPeriod_s;
  constexpr double kRate = kJerk / kAcceleration;  // 1/s
  const double most = std::min(kRate * (upper - last), kAcceleration);
  const double least = std::max(kRate * (lower - last), -kAcceleration);
  return last + std::max(std::min(acceleration, most), least) * kPeriod_s;
}

}  // namespace

VectorM led_speeds(const CommandFrame& command, const VectorM& q) noexcept {
  return command.dq_m + kGain * (command.q_m - q);
}

VectorM limited_speeds(const VectorM& wanted, const VectorM& q, const VectorM& last,
                       const VectorM& last_acceleration) noexcept {
  VectorM speeds = wanted;
  for (int i = 0; i < kJoints; ++i) {
    const SpeedLimit& limit = kSpeedLimits[i];
    const double upper = most_at(limit, limit.q_max - q[i]);
    const double lower = -most_at(limit, q[i] - limit.q_min);
    speeds[i] = limited_speed(wanted[i], lower, upper, last[i], last_acceleration[i]);
  }
  return speeds;
}

}  // namespace hg::franka

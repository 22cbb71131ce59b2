#include "hg/controller/estimation/unit_calibration.h"

#include <Eigen/Cholesky>

#include "hg/controller/estimation/low_pass.h"
#include "hg/core/cross.h"

namespace hg::estimation {
namespace {

constexpr double kCompared_Hz = 10.0;          // below which encoders and unit are compared
constexpr double kMean_s = 5.0;                // averaging time of a link's acceleration
constexpr double kMoves = 0.05;                // m/s^2 from that mean: the link is accelerated
constexpr double kMovedEnough_s = 5.0;         // time of motion after which a unit counts as known
constexpr double kMisfit_s = 1.0;              // averaging time of the misfit
constexpr double kMostMisfit = 0.15 * 0.15;    // (m/s^2)^2
constexpr double kMostVariance = 0.05 * 0.05;  // (m/s^2)^2
constexpr double kMemory_s = 60.0;             // of motion like the present one
constexpr double kSamplesPerSecond = 2.0 * kCompared_Hz;               // that say something new
constexpr double kAccelerometerError = 0.05, kGyroscopeError = 0.005;  // m/s^2, rad/s
// prior before any measurement: 0, with these deviations
constexpr double kTurn = 3.0, kGyroscopeBias = 0.1, kBias = 1.0, kPlace = 0.3;

using Turns = Eigen::Matrix<double, UnitCalibration::kTurns, 1>;
using Motions = Eigen::Matrix<double, UnitCalibration::kMotions, 1>;

Turns turns_of(const Eigen::Vector3d& omega) noexcept {
  Turns turns;
  turns << omega, 1.0;
  return turns;
}

Motions motions_of(const LinkMotion& motion) noexcept {
  const Eigen::Matrix3d turn = cross_matrix(motion.omega);
  const Eigen::Matrix3d S = cross_matrix(motion.alpha) + turn * turn;
  Motions motions;
  motions << motion.a, 1.0, S.col(0), S.col(1), S.col(2);
  return motions;
}

// low-passed signals: motions but for the 1, turns but for the 1, reading
UnitCalibration::Signals packed(const Motions& motions, const Eigen::Vector3d& omega,
                                const UnitReading& reading) noexcept {
  UnitCalibration::Signals all;
  all << motions.head<3>(), motions.tail<9>(), omega, reading.a, reading.omega;
  return all;
}
Motions motions_in(const UnitCalibration::Signals& all) noexcept {
  Motions motions;
  motions << all.head<3>(), 1.0, all.segment<9>(3);
  return motions;
}

// Scales old and new data down alike once there is more than kMemory_s of what a second brings now;
// at most by as much as that second brings.
template <typename Information, typename Sum>
void forget(double dt, double per_second, Information& information, Sum& sum) noexcept {
  const double trace = information.trace();
  if (trace <= kMemory_s * per_second) return;
  const double kept = 1.0 - dt * per_second / trace;
  information *= kept;
  sum *= kept;
}

template <typename Regressor, typename Information, typename Sum>
void accumulate(double dt, double error, const Regressor& regressor, const Eigen::Vector3d& shown,
                Information& information, Sum& sum) noexcept {
  const double per_second = kSamplesPerSecond / (error * error);
  information.noalias() += dt * per_second * regressor * regressor.transpose();
  sum.noalias() += dt * per_second * regressor * shown.transpose();
  forget(dt, per_second * regressor.squaredNorm(), information, sum);
}

}  // namespace

void learn(double dt, const LinkMotion& motion, const UnitReading& reading,
           UnitCalibration& unit) noexcept {
  const UnitCalibration::Signals now = packed(motions_of(motion), motion.omega, reading);
  if (!unit.is_started) {
    unit.is_started = true;
    unit.slow = unit.slower = now;
    unit.a_mean = motion.a;
  }
  const double pole = low_pass_pole(kCompared_Hz, dt);
  low_pass(pole, now, unit.slow);
  low_pass(pole, unit.slow, unit.slower);
  const Motions motions = motions_in(unit.slower);
  const Eigen::Vector3d a = unit.slower.head<3>(), omega = unit.slower.segment<3>(12);
  const Eigen::Vector3d shown = unit.slower.segment<3>(15);
  const Eigen::Vector3d missing = shown - unit.accelerometer.transpose() * motions;
  unit.misfit += dt / kMisfit_s * (missing.squaredNorm() / 3.0 - unit.misfit);
  unit.a_mean += dt / kMean_s * (a - unit.a_mean);
  // at rest there is nothing new: earlier motion must not be forgotten
  if ((a - unit.a_mean).norm() <= kMoves) return;
  unit.moved_s += dt;
  accumulate(dt, kGyroscopeError, turns_of(omega), unit.slower.tail<3>(), unit.turn_information,
             unit.turn_sum);
  accumulate(dt, kAccelerometerError, motions, shown, unit.information, unit.sum);
}

void solve(UnitCalibration& unit) noexcept {
  auto turn_information = unit.turn_information;
  turn_information.diagonal().head<3>().array() += 1.0 / (kTurn * kTurn);
  turn_information(3, 3) += 1.0 / (kGyroscopeBias * kGyroscopeBias);
  unit.gyroscope = turn_information.llt().solve(unit.turn_sum);

  auto information = unit.information;
  information.diagonal().head<3>().array() += 1.0 / (kTurn * kTurn);
  information(3, 3) += 1.0 / (kBias * kBias);
  information.diagonal().tail<9>().array() += 1.0 / (kPlace * kPlace);
  const Eigen::LLT<decltype(information)> factor(information);
  unit.accelerometer = factor.solve(unit.sum);
  const Motions spread = factor.matrixL().solve(motions_in(unit.slower));
  unit.variance = spread.squaredNorm();
}

UnitReading expected(const UnitCalibration& unit, const LinkMotion& motion) noexcept {
  return {.a = unit.accelerometer.transpose() * motions_of(motion),
          .omega = unit.gyroscope.transpose() * turns_of(motion.omega)};
}

AccelerometerGains gains_of(const UnitCalibration& unit) noexcept {
  const auto of_S = [&](int row, int column) noexcept -> Eigen::Vector3d {
    return unit.accelerometer.row(4 + 3 * column + row).transpose();
  };
  AccelerometerGains gains;
  gains.of_a = unit.accelerometer.topRows<3>().transpose();
  gains.of_alpha << of_S(2, 1) - of_S(1, 2), of_S(0, 2) - of_S(2, 0), of_S(1, 0) - of_S(0, 1);
  return gains;
}

bool is_known(const UnitCalibration& unit) noexcept {
  return unit.moved_s > kMovedEnough_s && unit.misfit < kMostMisfit &&
         unit.variance < kMostVariance;
}

}  // namespace hg::estimation

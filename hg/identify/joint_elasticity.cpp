#include "hg/identify/joint_elasticity.h"

#include <fmt/format.h>

#include <cmath>

#include "hg/core/interval.h"
#include "hg/identify/block_regression.h"

namespace hg::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSmoothing_s = 0.01;    // half width
constexpr double kRow_s = 0.005;         // distance of rows
constexpr double kEncoderError = 1e-4;   // rad, deviation of the errors per turn of the joint, [A]
constexpr double kSure = 0.1;            // of the stiffness
constexpr double kSureOfDamping = 0.35;  // of the damping
constexpr Eigen::Index kPerTurnOfJoint = 4, kPerTurnOfMotor = 8;

// Smoothed signals of one stretch of samples.
struct Signals {
  VectorXd twist, tau, dtau, ddtau, dddtau;
  MatrixXd others;  // columns of offset and periodic errors
};

// cos and sin of once and twice `angle`
MatrixXd waves(const VectorXd& angle) {
  MatrixXd result(angle.size(), 4);
  for (int order = 1; order <= 2; ++order) {
    result.col(2 * order - 2) = (order * angle.array()).cos();
    result.col(2 * order - 1) = (order * angle.array()).sin();
  }
  return result;
}

Signals signals_of(const JointMotion& part, int joint, double period_s, double gear_ratio) {
  const int half = static_cast<int>(std::lround(kSmoothing_s / period_s));
  const VectorXd q = part.q.col(joint), theta = part.theta.col(joint);
  Signals s;
  s.twist = smoothed(theta - q, half);
  s.tau = smoothed(part.tau.col(joint), half);
  s.dtau = slope(s.tau, period_s);
  s.ddtau = slope(s.dtau, period_s);
  s.dddtau = slope(s.ddtau, period_s);
  const bool has_gear = gear_ratio > 1.0;
  s.others.resize(q.size(), 1 + kPerTurnOfJoint + (has_gear ? kPerTurnOfMotor : 0));
  s.others.col(0).setOnes();
  s.others.middleCols(1, kPerTurnOfJoint) = waves(q);
  if (has_gear) {
    const MatrixXd motor = smoothed(waves(gear_ratio * theta), half);
    s.others.rightCols(8) << motor, slope(motor, period_s);  // the ripple of tau has a slope, too
  }
  return s;
}

// Calls take(k) for each row of a part, and begin() before the first of each block.
template <typename Begin, typename Take>
void for_each_row(Eigen::Index samples, double period_s, Begin&& begin, Take&& take) {
  const auto edge = static_cast<Eigen::Index>(std::lround(kSmoothing_s / period_s)) + 3;
  const auto step = std::max<Eigen::Index>(1, std::lround(kRow_s / period_s));
  const auto block = std::max<Eigen::Index>(1, std::lround(kBlock_s / kRow_s));
  Eigen::Index row = 0;
  for (Eigen::Index k = edge; k + edge < samples; k += step) {
    if (row++ % block == 0) begin();
    take(k);
  }
}

// The regression for one value of T; parameters: 1/K, T/K, the others.
Regressed regress(const std::vector<Signals>& parts, double period_s, double T, int& blocks) {
  const Eigen::Index others = parts.front().others.cols();
  BlockRegression regression(2 + others);
  MatrixXd row(1, 2 + others);
  for (const Signals& s : parts) {
    for_each_row(
        s.tau.size(), period_s, [&] { regression.begin_block(); },
        [&](Eigen::Index k) {
          row << s.tau[k] + T * T * s.ddtau[k], -s.dtau[k] - T * T * s.dddtau[k], s.others.row(k);
          regression.add(row, VectorXd::Constant(1, s.twist[k]));
        });
  }
  blocks = regression.blocks();
  if (blocks < kFewestOfBlocks) return {};
  VectorXd prior = VectorXd::Constant(2 + others, kInfinity);
  prior.segment(3, kPerTurnOfJoint).setConstant(kEncoderError);
  return regression.solve(prior);
}

double deviation_of(const std::vector<JointMotion>& parts, const auto& series) {
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (const JointMotion& part : parts) {
    const VectorXd x = series(part);
    count += static_cast<double>(x.size());
    sum += x.sum();
    squares += x.squaredNorm();
  }
  return std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
}

// K = 1 / a, D = b / a^2
void report(const Regressed& found, JointElasticity& joint) {
  const double a = found.x[0], b = found.x[1];
  const double da = std::sqrt(found.covariance(0, 0));
  joint.residual = found.residual;
  const double K = 1.0 / a, relative = std::hypot(da / a, kTorqueGain);
  if (a > 0.0 && relative <= kSure) {
    joint.stiffness = {K, relative * K, true};
  } else {
    joint.missing.push_back(
        fmt::format("stiffness: its torque changed by {:.2g} Nm rms and its twist by {:.2g} rad; "
                    "load it more, with a weight or by hand",
                    joint.torque, joint.twist));
    return;
  }
  const Eigen::Vector2d by(-2.0 * b / (a * a * a), 1.0 / (a * a));
  const double D = b / (a * a);
  const double variance = by.dot(found.covariance.topLeftCorner<2, 2>() * by);
  const double dD = std::hypot(std::sqrt(variance), kTorqueGain * D);
  if (dD <= kSureOfDamping * D) {
    joint.damping = {D, dD, true};
  } else {
    joint.missing.push_back(fmt::format(
        "damping: {:.2g} +- {:.1g} Nms/rad; its torque must change faster: strike or shake it", D,
        2.0 * dD));
  }
}

}  // namespace

JointElasticity identify_elasticity(const std::vector<JointMotion>& parts, int joint,
                                    double period_s, const ActuatorModel& nominal,
                                    double gear_ratio) {
  constexpr int kRounds = 4;  // T converges by a digit and more per round
  JointElasticity result;
  result.stiffness.value = nominal.stiffness;
  result.damping.value = nominal.damping;
  result.torque = deviation_of(parts, [&](const JointMotion& p) { return p.tau.col(joint); });
  result.twist = deviation_of(
      parts, [&](const JointMotion& p) { return p.theta.col(joint) - p.q.col(joint); });
  std::vector<Signals> signals;
  for (const JointMotion& part : parts) {
    signals.push_back(signals_of(part, joint, period_s, gear_ratio));
  }
  double T = 0.0;
  int blocks = 0;
  Regressed found;
  for (int round = 0; round < kRounds; ++round) {
    found = regress(signals, period_s, T, blocks);
    if (blocks < kFewestOfBlocks) {
      result.missing.push_back(
          fmt::format("stiffness: it moved for {} s only, {} are needed", blocks, kFewestOfBlocks));
      return result;
    }
    T = found.x[1] / found.x[0];
    if (!(T > 0.0 && T < kSmoothing_s)) T = 0.0;
  }
  report(found, result);
  return result;
}

}  // namespace hg::identify

#include "hg/identify/inertia_rows.h"

#include <algorithm>
#include <cmath>

#include "hg/core/interval.h"
#include "hg/identify/joint_elasticity.h"

namespace hg::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSmoothing_s = 0.012;  // half width
constexpr double kRow_s = 0.01;         // distance of rows
constexpr double kReversal = 0.02;      // rad/s, over which friction changes its sign
// Deviation of gains and cross-talk of a force/torque sensor, as shares of full scales that are 30
// mm apart, [A]
constexpr double kWrenchGain = 0.01, kScaleRatio = 0.03;
constexpr double kWrenchDelay = 2e-3;  // s, deviation of its delay, [A]
constexpr Eigen::Index kPerJoint = 8;  // offset, viscous, Coulomb, gain, ripple
constexpr Eigen::Index kRipples = 4;
constexpr Eigen::Index kGains = 36;                  // and cross-talk
constexpr Eigen::Index kPerSensor = 6 + kGains + 1;  // offset, gains, delay

// Of the error of the reading `i` by the reading `k`, k by k.
VectorXd wrench_priors() {
  const auto scale = [](Eigen::Index axis) { return axis < 3 ? 1.0 : kScaleRatio; };
  VectorXd priors(kGains);
  for (Eigen::Index k = 0; k < 6; ++k) {
    for (Eigen::Index i = 0; i < 6; ++i) priors[6 * k + i] = kWrenchGain * scale(i) / scale(k);
  }
  return priors;
}

}  // namespace

InertiaRows::InertiaRows(InertiaModel& model, const BaseParameters& base,
                         const std::vector<JointMotion>& parts, const DeviceModel& device,
                         const VectorM& gear_ratio)
    : model_(model),
      base_(base),
      bases_(static_cast<Eigen::Index>(base.chosen.size())),
      n_m_(device.n_m),
      n_p_(device.n_p),
      gear_ratio_(gear_ratio),
      least_(VectorXd::Constant(n_m_, kInfinity)),
      largest_(-least_),
      squares_(VectorXd::Zero(n_m_)) {
  for (int i = 0; i < device.n_m; ++i) joints_.push_back({.name = device.manipulator_joint(i)});
  for (const JointMotion& part : parts) add(part, device);
}

void InertiaRows::add(const JointMotion& part, const DeviceModel& device) {
  const double period = device.dt();
  const int half = static_cast<int>(std::lround(kSmoothing_s / period));
  Series positions(part.samples(), n_p_ + n_m_);
  positions << part.q_p, part.q;
  const Series q = smoothed(positions, half), dq = slope(q, period), ddq = slope(dq, period);
  const Series tau = smoothed(part.tau, half), wrench = smoothed(part.wrench_S, half);
  const Series wrench_rate = slope(wrench, period);
  const Series ripple = smoothed(ripples(part), half);
  const auto step = std::max<Eigen::Index>(1, std::lround(kRow_s / period));
  const auto block = static_cast<Eigen::Index>(std::lround(kBlock_s / kRow_s));
  Eigen::Index count = 0;
  for (Eigen::Index k = half + 2; k + half + 2 < q.rows(); k += step) {
    if (count++ % block == 0) begins_.push_back(rows_.size());
    rows_.push_back(row_of({q.row(k).transpose(), dq.row(k).transpose(), ddq.row(k).transpose(),
                            wrench.row(k).transpose()},
                           tau.row(k).transpose(), ripple.row(k).transpose(),
                           wrench_rate.row(k).transpose()));
    const VectorXd now = q.row(k).tail(n_m_).transpose();
    least_ = least_.cwiseMin(now);
    largest_ = largest_.cwiseMax(now);
    squares_ += ddq.row(k).tail(n_m_).transpose().cwiseAbs2();
  }
}

// cos and sin of once and twice per turn of the motor, joint by joint; 0 without a gear.
Series InertiaRows::ripples(const JointMotion& part) const {
  Series result = Series::Zero(part.samples(), kRipples * n_m_);
  const Series& angle = part.theta.cols() == n_m_ ? part.theta : part.q;
  for (Eigen::Index i = 0; i < n_m_; ++i) {
    if (!(i < gear_ratio_.size() && gear_ratio_[i] > 1.0)) continue;
    const auto turn = (gear_ratio_[i] * angle.col(i)).array();
    result.middleCols<kRipples>(kRipples * i) << turn.cos(), turn.sin(), (2.0 * turn).cos(),
        (2.0 * turn).sin();
  }
  return result;
}

InertiaRows::Row InertiaRows::row_of(const Moment& moment, const VectorXd& tau,
                                     const VectorXd& ripple, const Vector6& wrench_rate) const {
  model_.update(moment);
  const MatrixXd W = model_.wrench_columns();
  const Vector6 user = model_.user_wrench();
  const VectorXd speed = moment.dq.tail(n_m_);
  Row row;
  const VectorXd expected = model_.nominal_torques() + W * user;  // without the noise of tau
  row.y = tau - expected;
  row.A = MatrixXd::Zero(n_m_, bases_ + kPerJoint * n_m_ + kPerSensor);
  row.A.leftCols(bases_) = model_.regressor()(Eigen::all, base_.chosen);
  auto others = row.A.rightCols(kPerJoint * n_m_ + kPerSensor);
  for (Eigen::Index i = 0; i < n_m_; ++i) {
    others.row(i).segment<kPerJoint>(kPerJoint * i) << 1.0, speed[i],
        std::tanh(speed[i] / kReversal), expected[i],
        ripple.segment<kRipples>(kRipples * i).transpose();
  }
  others.rightCols<kPerSensor>().leftCols<6>() = -W;
  for (Eigen::Index k = 0; k < 6; ++k) {
    others.rightCols<kGains + 1>().middleCols<6>(6 * k) = W * moment.wrench_S[k];
  }
  others.rightCols<1>() = W * wrench_rate;
  return row;
}

std::vector<JointFit> InertiaRows::motion() const {
  std::vector<JointFit> joints = joints_;
  if (rows_.empty()) return joints;
  for (Eigen::Index i = 0; i < n_m_; ++i) {
    JointFit& joint = joints[static_cast<std::size_t>(i)];
    joint.way = largest_[i] - least_[i];
    joint.acceleration = std::sqrt(squares_[i] / static_cast<double>(rows_.size()));
  }
  return joints;
}

Regressed InertiaRows::solve(const VectorXd& deviation) const {
  const Eigen::Index columns = bases_ + kPerJoint * n_m_ + kPerSensor;
  BlockRegression regression(columns);
  const VectorXd weight = deviation.cwiseInverse();
  std::size_t block = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (block < begins_.size() && begins_[block] == i) {
      regression.begin_block();
      ++block;
    }
    regression.add(weight.asDiagonal() * rows_[i].A, weight.cwiseProduct(rows_[i].y));
  }
  VectorXd prior = VectorXd::Constant(columns, kInfinity);
  for (Eigen::Index i = 0; i < n_m_; ++i) prior[bases_ + kPerJoint * i + 3] = kTorqueGain;
  prior.tail<kGains + 1>() << wrench_priors(), kWrenchDelay;
  return regression.solve(prior);
}

// rms of each joint
VectorXd InertiaRows::residuals(const VectorXd& x) const {
  VectorXd squares = VectorXd::Zero(n_m_);
  for (const Row& row : rows_) squares += (row.y - row.A * x).cwiseAbs2();
  return (squares / static_cast<double>(rows_.size())).cwiseSqrt();
}

// rms about the mean, which is the offset of the torque sensor
VectorXd InertiaRows::deviation_by_files() const {
  VectorXd mean = VectorXd::Zero(n_m_), squares = mean;
  for (const Row& row : rows_) mean += row.y / static_cast<double>(rows_.size());
  for (const Row& row : rows_) squares += (row.y - mean).cwiseAbs2();
  return (squares / static_cast<double>(rows_.size())).cwiseSqrt();
}

Regressed InertiaRows::solve(std::vector<JointFit>& joints) const {
  constexpr int kRounds = 3;
  VectorXd deviation = deviation_by_files();
  for (Eigen::Index i = 0; i < n_m_; ++i) joints[static_cast<std::size_t>(i)].before = deviation[i];
  Regressed found;
  for (int round = 0; round < kRounds; ++round) {
    found = solve(deviation.cwiseMax(1e-6));
    deviation = residuals(found.x);
  }
  for (Eigen::Index i = 0; i < n_m_; ++i) joints[static_cast<std::size_t>(i)].after = deviation[i];
  return found;
}

}  // namespace hg::identify

#include "hg/analysis/truth_summary.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hg::analysis {

HighPass::HighPass(double cutoff_Hz, double rate_Hz) noexcept {
  const double k = std::tan(std::numbers::pi * cutoff_Hz / rate_Hz);
  const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
  b_ = norm;
  a1_ = 2.0 * (k * k - 1.0) * norm;
  a2_ = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
  x1_.setZero();
  x2_ = y1_ = y2_ = x1_;
}

Eigen::Vector3d HighPass::step(const Eigen::Vector3d& value) noexcept {
  if (!is_started_) {
    x1_ = x2_ = value;  // no step at the beginning
    is_started_ = true;
  }
  const Eigen::Vector3d y = b_ * (value - 2.0 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
  x2_ = x1_;
  x1_ = value;
  y2_ = y1_;
  y1_ = y;
  return y;
}

TruthSummary::TruthSummary(const LimitCatalogue& catalogue, FindPositions positions, double rate_Hz,
                           const VectorM& torque_rated)
    : positions_of_(std::move(positions)),
      above_5_(5.0, rate_Hz),
      above_20_(20.0, rate_Hz),
      torque_rated_(torque_rated),
      sum_torque_(VectorM::Zero(torque_rated.size())) {
  for (const LimitInfo& limit : catalogue) {
    if (limit.kind != LimitKind::kTwinJoint) ranges_.push_back(limit.range);
  }
  worst_excess_.resize(ranges_.size(), 0.0);
}

void TruthSummary::add(const Sample& sample) {
  const CycleRecord& record = sample.record;
  const Truth& truth = sample.truth;
  if (!truth.is_known) return;
  positions_of_(truth, positions_);
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const double inside = std::clamp(positions_[i], ranges_[i].lb, ranges_[i].ub);
    worst_excess_[i] = std::max(worst_excess_[i], std::abs(positions_[i] - inside));
  }
  bystander_.force = std::max(bystander_.force, truth.bystander.force);
  bystander_.pressure = std::max(bystander_.pressure, truth.bystander.pressure);
  bystander_.compression = std::max(bystander_.compression, truth.bystander.compression);
  if (record.mode != Mode::kRunning && record.mode != Mode::kStopping) return;
  int joint = -1;
  const double error = (record.reference.q_m - truth.q_m).cwiseAbs().maxCoeff(&joint);
  if (error > max_joint_error_) {
    max_joint_error_ = error;
    worst_joint_ = joint;
  }
  // the rest concerns quantities felt by the user
  if (record.mode != Mode::kRunning) return;
  ++cycles_;
  max_hand_distance_ = std::max(max_hand_distance_, (record.T_B_E.p - truth.T_B_H.p).norm());
  if (record.tracking.is_clamped) ++clamped_cycles_;
  const VectorM& share = record.tracking.torque_share;
  if (max_torque_share_.size() != share.size()) max_torque_share_ = share;
  max_torque_share_ = max_torque_share_.cwiseMax(share);
  if (share.size() > 0) sum_torque_ += truth.tau_motor.cwiseAbs2();

  const Eigen::Vector3d a = truth.acceleration.head<3>();
  sum_force_ += truth.w_H.head<3>().norm();
  sum_vibration_ += above_5_.step(a).squaredNorm();
  sum_vibration_20_ += above_20_.step(a).squaredNorm();
}

VectorM TruthSummary::rated_torque_share() const {
  if (max_torque_share_.size() == 0) return {};
  return (sum_torque_ / static_cast<double>(cycles_)).cwiseSqrt().cwiseQuotient(torque_rated_);
}

double TruthSummary::mean_force() const noexcept {
  return cycles_ > 0 ? sum_force_ / static_cast<double>(cycles_) : 0.0;
}

double TruthSummary::rms(double sum_of_squares) const noexcept {
  return cycles_ > 0 ? std::sqrt(sum_of_squares / static_cast<double>(cycles_)) : 0.0;
}

}  // namespace hg::analysis

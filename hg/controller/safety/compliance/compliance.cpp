#include "hg/controller/safety/compliance/compliance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hg::compliance {
namespace {

constexpr double kFilter_s = 0.005;
constexpr double kLeast = 0.05;  // threshold without noise and motion, times the peak torque
constexpr double kLeastOfArm =
    0.035;                           // and times that of the strongest joint: wrists feel the user
constexpr double kDeviations = 6.0;  // threshold, standard deviations of the noise
constexpr double kModelError = 0.2;  // threshold, share of the torque that moves the joint
constexpr double kNoiseMemory_s = 1.0;  // averaging time of the noise
constexpr double kLoadMemory_s = 0.15;  // a model is wrong for as long as filters remember
constexpr double kEnds = 0.5;           // share of its threshold below which a contact ends
constexpr double kQuiet_s = 0.05;       // time below that share until a contact ends
constexpr double kGantryGain = 0.01;    // m/s per N, rad/s per Nm
constexpr double kDamping = 0.1;        // m or rad: singular directions of the arm carry nothing

double least_threshold(const VectorM& torque_max, int joint) noexcept {
  return std::max(kLeast * torque_max[joint], kLeastOfArm * torque_max.maxCoeff());
}

void start(const ComplianceInput& input, ComplianceState& state) noexcept {
  const auto n = input.torque.size();
  state.torque = state.variance = state.load = VectorM::Zero(n);
  state.away = VectorP(0);
  state.is_started = true;
}

// Learns the noise from torques far below a contact. Noise raises a threshold to at most twice the
// minimum.
void learn(const VectorM& torque_max, double dt, ComplianceState& state) noexcept {
  for (int i = 0; i < state.torque.size(); ++i) {
    const double most = least_threshold(torque_max, i) / kDeviations;
    double& variance = state.variance[i];
    variance += dt / kNoiseMemory_s * (state.torque[i] * state.torque[i] - variance);
    variance = std::min(variance, most * most);
  }
}

// Wrench w with J^T w = torque of the manipulator's part of J.
Vector6 wrench_of(const ComplianceInput& input, const VectorM& torque) noexcept {
  const auto J = input.J.rightCols(torque.size());
  Eigen::Matrix<double, 6, 6> normal = J.lazyProduct(J.transpose());
  normal.diagonal().array() += kDamping * kDamping;
  Vector6 w = J.lazyProduct(torque);
  normal.ldlt().solveInPlace(w);
  const double force = w.head<3>().norm(), moment = w.tail<3>().norm();
  const double share = std::max(force / kForceMax, moment / kMomentMax);
  return share > 1.0 ? Vector6(w / share) : w;
}

// Torques beyond the thresholds, continuous where a contact begins and ends.
VectorM beyond(const VectorM& torque_max, const ComplianceState& state) noexcept {
  VectorM torque = state.torque;
  for (int i = 0; i < torque.size(); ++i) {
    const double most = threshold(torque_max, state, i);
    torque[i] -= std::clamp(torque[i], -most, most);
  }
  return torque;
}

}  // namespace

VectorM peak_torques(const DeviceModel& device) {
  VectorM torque(static_cast<Eigen::Index>(device.actuators.size()));
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    torque[i] = device.actuators[i].torque_max;
  }
  return torque;
}

double threshold(const VectorM& torque_max, const ComplianceState& state, int joint) noexcept {
  const double noise = kDeviations * std::sqrt(state.variance[joint]);
  return least_threshold(torque_max, joint) + noise + kModelError * state.load[joint];
}

TouchReport react_to_contact(const VectorM& torque_max, double dt, const ComplianceInput& input,
                             ComplianceState& state) noexcept {
  if (!state.is_started) start(input, state);
  TouchReport report;
  state.torque += dt / kFilter_s * (input.torque - state.torque);
  state.load = input.load.cwiseAbs().cwiseMax((1.0 - dt / kLoadMemory_s) * state.load);
  for (int i = 0; i < state.torque.size(); ++i) {
    const double share = std::abs(state.torque[i]) / threshold(torque_max, state, i);
    report.share = std::max(report.share, share);
    if (share >= 1.0) report.joint = i;
  }
  state.quiet_s = report.share < kEnds ? state.quiet_s + dt : 0.0;
  if (!state.is_reported && report.share < kEnds) learn(torque_max, dt, state);
  state.is_reported = report.share >= 1.0 || (state.is_reported && state.quiet_s < kQuiet_s);

  report.torque = state.torque;
  report.is_reported = state.is_reported;
  state.away.resize(0);
  if (!state.is_reported) return report;
  report.wrench = wrench_of(input, beyond(torque_max, state));
  state.away.noalias() = kGantryGain * input.J.leftCols(input.n_p).transpose() * report.wrench;
  state.away = state.away.cwiseMin(kGantrySpeed).cwiseMax(-kGantrySpeed);
  return report;
}

}  // namespace hg::compliance

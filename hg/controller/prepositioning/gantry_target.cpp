#include "hg/controller/prepositioning/gantry_target.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hg/core/error.h"
#include "hg/core/rotation.h"

namespace hg::prepositioning {
namespace {

constexpr int kSteps = 2;              // per cycle; the hand moves 2 mm in between
constexpr double kPoseWeight = 1e6;    // square; 1 m or rad of the pose against 1 rad of posture
constexpr double kDamping = 1e-3;      // square, 1 rad of posture is 1: halves no step
constexpr double kLargestStep = 0.05;  // m and rad
constexpr double kRounding = 1e-12;    // m and rad
constexpr double kLost = 0.05;         // m and rad beside the hand: restart

}  // namespace

GantryTarget::GantryTarget(const DeviceModel& device)
    : has_closed_form_(device.has_closed_form),
      n_p_(device.n_p),
      handle_(device.handle),
      chain_(device.chain),
      range_(device.gantry_range) {
  if (has_closed_form_ && (n_p_ != 2 || device.n_m != 6)) {
    throw SetupError(
        "prepositioning: the closed-form target needs two gantry joints and six manipulator "
        "joints");
  }
  if (has_closed_form_) lengths_ = model::haptic_giant::lengths_of(device.chain, handle_);
  for (const limits::JointLimits& joint : device.joint_limits) {
    range_.push_back({joint.q_min, joint.q_max});
  }
  const int n = n_p_ + device.n_m;
  goal_ = VectorPM::Constant(n, std::numeric_limits<double>::quiet_NaN());
  if (device.posture.size() > 0) goal_.tail(device.n_m) = device.posture;
  for (const model::Joint& joint : chain_.model().joints()) {
    is_free_.push_back(joint.type == model::JointType::kContinuous);
  }
  at_rest_ = VectorPM::Zero(n);
}

VectorP GantryTarget::step(const RobotState& robot, const VectorM& q_m,
                           TargetState& state) noexcept {
  if (n_p_ == 0) return VectorP(0);
  if (has_closed_form_) return model::haptic_giant::gantry_target(robot.q_p, q_m, lengths_);

  const VectorPM q_now = stacked(robot.q_p, q_m);
  chain_.update_kinematics(q_now, at_rest_);
  const Pose T_B_H = chain_.pose(handle_);
  if (!state.is_started) {
    state.q = q_now;
    state.is_started = true;
  }
  double error = 0.0;
  for (int i = 0; i < kSteps; ++i) error = improve(T_B_H, state.q);
  if (!(error < kLost)) {
    // the posture misses the hand, behind a singularity or a limit: stay and restart
    state.q = q_now;
  }
  return state.q.head(n_p_);
}

// One step of minimising kPoseWeight |pose error|^2 + |goal - q|^2; returns the pose error before.
double GantryTarget::improve(const Pose& T_B_H, VectorPM& q) noexcept {
  chain_.update_kinematics(q, at_rest_);
  const Pose pose = chain_.pose(handle_);
  Vector6 error;
  error << T_B_H.p - pose.p, rotation_between(pose.R, T_B_H.R);

  const auto n = q.size();
  const model::Jacobian J = chain_.jacobian(handle_);
  MatrixPM H(n, n);
  H.noalias() = kPoseWeight * (J.transpose().lazyProduct(J));
  VectorPM g(n);
  g.noalias() = kPoseWeight * (J.transpose().lazyProduct(error));
  for (int i = 0; i < n; ++i) {
    H(i, i) += kDamping;
    if (std::isnan(goal_[i])) continue;
    const double missing = goal_[i] - q[i];
    H(i, i) += 1.0;
    g[i] += is_free_[i] ? std::remainder(missing, 2.0 * std::numbers::pi) : missing;
  }
  q += limited_step(H, g, q);
  return error.norm();
}

// Solves H step = g; joints that would leave their range stop at its end, the others make up for
// it.
VectorPM GantryTarget::limited_step(MatrixPM H, VectorPM g, const VectorPM& q) const noexcept {
  const auto limited = [&](int i, double step) {
    const Interval range = range_[i];
    return std::clamp(q[i] + step, range.lb, range.ub) - q[i];
  };
  VectorPM step = H.ldlt().solve(g);
  const double largest = step.lpNorm<Eigen::Infinity>();
  if (largest > kLargestStep) {
    g *= kLargestStep / largest;
    step *= kLargestStep / largest;
  }

  std::array<bool, kMaxGantry + kMaxManipulator> is_held{};
  for (int pass = 0; pass < q.size(); ++pass) {
    bool is_new = false;
    for (int i = 0; i < q.size(); ++i) {
      bool& held = is_held[i];
      const double end = limited(i, step[i]);
      if (held || std::abs(end - step[i]) < kRounding) continue;
      held = is_new = true;
      g -= end * H.col(i);
      H.row(i).setZero();
      H.col(i).setZero();
      H(i, i) = 1.0;
      g[i] = end;
    }
    if (!is_new) break;
    step = H.ldlt().solve(g);
  }

  for (int i = 0; i < q.size(); ++i) {
    step[i] = limited(i, std::clamp(step[i], -kLargestStep, kLargestStep));
  }
  return step;
}

}  // namespace hg::prepositioning

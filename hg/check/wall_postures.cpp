#include "hg/check/wall_postures.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hg/core/rotation.h"
#include "hg/core/stacked.h"
#include "hg/model/haptic_giant.h"

namespace hg::check {
namespace {

constexpr double kReached = 1e-4;  // m and rad
constexpr double kDamping = 1e-6;  // of the steps, m^2 or rad^2

}  // namespace

WallPostures::WallPostures(const config::DeviceConfig& device)
    : device_(device.model),
      ranges_(workspace::joint_ranges(device)),
      shapes_(device.collision.shapes, device.collision.pairs.watched),
      chain_(device_.chain),
      at_rest_(Eigen::VectorXd::Zero(device_.chain.nv())),
      nominal_(0.5 * (ranges_.lower + ranges_.upper)) {
  for (Eigen::Index i = 0; i < device_.posture.size(); ++i) {
    if (!std::isnan(device_.posture[i])) nominal_[device_.n_p + i] = device_.posture[i];
  }
  chain_.update_kinematics(nominal_, at_rest_);
  start_ = chain_.pose(device_.handle);
}

std::optional<Eigen::VectorXd> WallPostures::at(const Pose& T_B_H) {
  const std::optional<Eigen::VectorXd> q =
      device_.has_closed_form ? closed_form(T_B_H) : led_to(T_B_H);
  if (!q || !is_permitted(*q)) return {};
  return q;
}

Eigen::VectorXd WallPostures::best_from(Eigen::VectorXd q, const std::function<double()>& worth) {
  constexpr double kStep = 0.1;  // rad or m
  constexpr int kSteps = 32, kCorrections = 3;
  chain_.update(q, at_rest_);
  const Pose pose = chain_.pose(device_.handle);
  double best = worth();
  const Eigen::VectorXd first = own_motion();
  if (first.isZero(0.0)) return q;
  for (const double side : {1.0, -1.0}) {
    const double before = best;
    Eigen::VectorXd direction = side * first;
    for (int i = 0; i < kSteps; ++i) {
      Eigen::VectorXd next = q;
      approach(pose, kStep * direction, next);
      double error = kInfinity;
      for (int k = 0; k < kCorrections && error > kReached; ++k) {
        error = approach(pose, Eigen::VectorXd::Zero(q.size()), next);
      }
      if (error > kReached || !is_permitted(next) || worth() <= best) break;
      best = worth();
      q = next;
      const Eigen::VectorXd turned = own_motion();
      direction = turned.dot(direction) < 0.0 ? -turned : turned;
    }
    chain_.update(q, at_rest_);
    if (best > before) break;
  }
  return q;
}

bool WallPostures::is_permitted(const Eigen::VectorXd& q) {
  if ((q.array() < ranges_.lower.array()).any() || (q.array() > ranges_.upper.array()).any()) {
    return false;
  }
  chain_.update(q, at_rest_);
  return workspace::permits_virtual_joints(device_, q) &&
         workspace::permits_boxes(device_, chain_) && shapes_.distance(chain_) > 0.0;
}

std::optional<Eigen::VectorXd> WallPostures::closed_form(const Pose& T_B_H) const {
  using model::haptic_giant::InverseStatus;
  const model::haptic_giant::Lengths lengths =
      model::haptic_giant::lengths_of(device_.chain, device_.handle);
  const auto is_exact = [](InverseStatus status) {
    return status == InverseStatus::kSolved || status == InverseStatus::kSingular;
  };
  Eigen::Vector2d q_p;
  Vector6 q_m;
  if (!is_exact(inverse_at_target(T_B_H, q_p, q_m, {}, lengths))) return {};
  for (int i = 0; i < 2; ++i) {
    q_p[i] = std::clamp(q_p[i], device_.gantry_range[i].lb, device_.gantry_range[i].ub);
  }
  if (!is_exact(inverse(T_B_H, q_p, {}, q_m, lengths))) return {};
  return Eigen::VectorXd(stacked(q_p, q_m));
}

std::optional<Eigen::VectorXd> WallPostures::led_to(const Pose& T_B_H) {
  constexpr double kStep = 0.05;  // m
  constexpr int kSteps = 2, kLastSteps = 20;
  Eigen::VectorXd q = nominal_;
  const Eigen::Vector3d way = T_B_H.p - start_.p;
  const int count = std::max(1, static_cast<int>(std::ceil(way.norm() / kStep)));
  for (int i = 1; i <= count; ++i) {
    const Pose wanted = {start_.p + way * (static_cast<double>(i) / count), T_B_H.R};
    for (int k = 0; k < (i < count ? kSteps : kLastSteps); ++k) {
      Eigen::VectorXd goal = nominal_ - q;
      goal.head(device_.n_p).setZero();
      const double error = approach(wanted, goal, q);
      if (i == count && k > 1 && error < kReached) return q;
    }
  }
  return {};
}

// One damped step of all joints to the pose, and across it by `goal`. Joints that it would take
// beyond their range stay there. Returns the error before it, m and rad.
double WallPostures::approach(const Pose& wanted, Eigen::VectorXd goal, Eigen::VectorXd& q) {
  constexpr double kStepMax = 0.3;
  chain_.update_kinematics(q, at_rest_);
  const Pose pose = chain_.pose(device_.handle);
  Vector6 error;
  error << wanted.p - pose.p, rotation_between(pose.R, wanted.R);
  model::Jacobian J = chain_.jacobian(device_.handle);
  Eigen::VectorXd step;
  for (bool is_held = true; is_held;) {
    Eigen::Matrix<double, 6, 6> A = J * J.transpose();
    A.diagonal().array() += kDamping;
    step = goal + J.transpose() * A.ldlt().solve(error - J * goal);
    is_held = false;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const bool leaves = (q[i] <= ranges_.lower[i] && step[i] < 0.0) ||
                          (q[i] >= ranges_.upper[i] && step[i] > 0.0);
      if (!leaves) continue;
      is_held = true;
      J.col(i).setZero();
      goal[i] = 0.0;
    }
  }
  step *= kStepMax / std::max(kStepMax, step.lpNorm<Eigen::Infinity>());
  q = (q + step).cwiseMax(ranges_.lower).cwiseMin(ranges_.upper);
  return error.lpNorm<Eigen::Infinity>();
}

Eigen::VectorXd WallPostures::own_motion() const {
  constexpr double kLeast = 1e-3;
  const int n = device_.n_m;
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(at_rest_.size());
  if (n <= 6) return motion;
  const model::Jacobian J = workspace::manipulator_jacobian(device_, chain_, device_.handle);
  Eigen::Matrix<double, 6, 6> A = J * J.transpose();
  A.diagonal().array() += kDamping;
  const Eigen::MatrixXd across =
      Eigen::MatrixXd::Identity(n, n) - J.transpose() * A.ldlt().solve(Eigen::MatrixXd(J));
  Eigen::Index column = 0;
  const double norm = across.colwise().norm().maxCoeff(&column);
  if (norm > kLeast) motion.tail(n) = across.col(column) / norm;
  return motion;
}

}  // namespace hg::check

#include "hg/model/inverse_kinematics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"
#include "hg/core/rotation.h"
#include "hg/model/chain_data.h"
#include "hg/model/joint_range.h"

namespace hg::model {
namespace {

constexpr int kStarts = 32;
constexpr int kReachSteps = 150;   // damped steps towards the pose
constexpr int kSettleSteps = 100;  // steps towards the goals at the pose
constexpr double kSolved = 1e-9;   // m and rad
constexpr double kSettled = 1e-10;
constexpr double kLargestStep = 0.5;  // m and rad, within the range of the linear model
constexpr double kTurn = 2.0 * std::numbers::pi;

class Search {
 public:
  Search(const ChainModel& chain, const InverseProblem& problem)
      : chain_(chain), problem_(problem), at_rest_(Eigen::VectorXd::Zero(chain.nv())) {
    if (chain.nq() != chain.nv()) {
      throw SetupError(chain.name() + ": inverse kinematics needs a chain without floating joints");
    }
  }

  // Moves from `q` to the pose, then in the null space towards the goals. Returns the second
  // result, unless it has lost the pose or is not permitted and the first one is.
  InverseResult from(Eigen::VectorXd q) {
    reach(q);
    const InverseResult reached = result_at(q);
    if (!reached.is_solved) return reached;
    settle(q);
    InverseResult best = reached;
    for (const Eigen::VectorXd& candidate : {unwound(q), q, unwound(reached.q)}) {
      const InverseResult result = result_at(candidate);
      if (result.is_permitted) return result;
      if (result.is_solved && !best.is_permitted) best = result;
    }
    return best;
  }

  bool is_better(const InverseResult& a, const InverseResult& b) const {
    if (a.is_permitted != b.is_permitted) return a.is_permitted;
    if (a.is_solved != b.is_solved) return a.is_solved;
    if (a.is_solved) return miss(a.q) < miss(b.q) - 1e-6;
    return std::hypot(a.position_error, a.angle_error) <
           std::hypot(b.position_error, b.angle_error) - 1e-9;
  }

 private:
  // Distance to the goals; coordinates without a goal do not count.
  double miss(const Eigen::VectorXd& q) const {
    double sum = 0.0;
    for (int i = 0; i < q.size(); ++i) {
      if (std::isfinite(problem_.goal[i])) sum += square(q[i] - problem_.goal[i]);
    }
    return std::sqrt(sum);
  }

  static double square(double x) { return x * x; }

  static bool is_solved(const Vector6& error) {
    return error.head<3>().norm() < kSolved && error.tail<3>().norm() < kSolved;
  }

  // error to the pose (position, rotation vector)
  Vector6 error_at(const Eigen::VectorXd& q) {
    chain_.update_kinematics(q, at_rest_);
    const Pose pose = chain_.pose(problem_.frame);
    Vector6 error;
    error << problem_.T_B_frame.p - pose.p, rotation_between(pose.R, problem_.T_B_frame.R);
    return error;
  }

  InverseResult result_at(const Eigen::VectorXd& q) {
    const Vector6 error = error_at(q);
    const bool is_permitted = is_solved(error) && (!problem_.permits || problem_.permits(q));
    return {is_solved(error), is_permitted, q, error.head<3>().norm(), error.tail<3>().norm()};
  }

  Eigen::VectorXd clamped(const Eigen::VectorXd& q) const {
    return q.cwiseMax(problem_.q_min).cwiseMin(problem_.q_max);
  }

  // Zeroes the Jacobian columns of joints that `step` would move beyond their limit; true if any.
  bool hold_at_limits(const Eigen::VectorXd& q, const Eigen::VectorXd& step, Eigen::MatrixXd& J,
                      std::vector<bool>& is_held) const {
    bool any = false;
    for (int i = 0; i < q.size(); ++i) {
      const bool leaves = (q[i] <= problem_.q_min[i] && step[i] < 0.0) ||
                          (q[i] >= problem_.q_max[i] && step[i] > 0.0);
      if (!leaves || is_held[i]) continue;
      is_held[i] = true;
      J.col(i).setZero();
      any = true;
    }
    return any;
  }

  // Levenberg-Marquardt on the error of the pose within the limits.
  void reach(Eigen::VectorXd& q) {
    double damping = 1e-2;
    Vector6 error = error_at(q);
    for (int k = 0; k < kReachSteps && error.norm() > 0.01 * kSolved; ++k) {
      Eigen::MatrixXd J = chain_.jacobian(problem_.frame);
      std::vector<bool> is_held(q.size(), false);
      Eigen::VectorXd step;
      do {
        Eigen::Matrix<double, 6, 6> A = J * J.transpose();
        A.diagonal().array() += damping;
        step = J.transpose() * A.ldlt().solve(error);
      } while (hold_at_limits(q, step, J, is_held));

      step *= std::min(1.0, kLargestStep / std::max(step.lpNorm<Eigen::Infinity>(), 1e-300));
      const Eigen::VectorXd next = clamped(q + step);
      const Vector6 next_error = error_at(next);
      if (next_error.norm() < error.norm()) {
        q = next;
        error = next_error;
        damping = std::max(0.2 * damping, 1e-15);
      } else {
        damping = std::min(5.0 * damping, 1e3);
        if (damping == 1e3) return;
        error_at(q);  // the Jacobian of the next step is that of q
      }
    }
  }

  // Steps in the null space of the Jacobian towards the goals; each keeps the pose to first order
  // and is corrected by the next ones.
  void settle(Eigen::VectorXd& q) {
    const int n = static_cast<int>(q.size());
    for (int k = 0; k < kSettleSteps; ++k) {
      const Vector6 error = error_at(q);
      Eigen::MatrixXd J = chain_.jacobian(problem_.frame);
      std::vector<bool> is_held(n, false);
      Eigen::VectorXd step;
      do {
        const LeastSquares rows(J);
        step = rows.solve(error);
        Eigen::MatrixXd N = Eigen::MatrixXd::Identity(n, n) - rows.pseudo_inverse() * J;
        Eigen::VectorXd wish = Eigen::VectorXd::Zero(n);
        Eigen::MatrixXd wished = Eigen::MatrixXd::Zero(n, n);
        for (int i = 0; i < n; ++i) {
          if (is_held[i]) N.row(i).setZero();
          if (!std::isfinite(problem_.goal[i])) continue;
          wish[i] = problem_.goal[i] - q[i] - step[i];
          wished.row(i) = N.row(i);
        }
        step += N * LeastSquares(wished, 1e-9).solve(wish);
      } while (hold_at_limits(q, step, J, is_held));
      step *= std::min(1.0, kLargestStep / std::max(step.lpNorm<Eigen::Infinity>(), 1e-300));
      q = clamped(q + step);
      if (step.norm() < kSettled) break;
    }
    reach(q);
  }

  // Removes whole turns where that brings a joint nearer to its goal, or to 0.
  Eigen::VectorXd unwound(Eigen::VectorXd q) const {
    for (std::size_t i = 0; i < chain_.model().joints().size(); ++i) {
      if (chain_.model().joints()[i].is_slide()) continue;
      const auto k = static_cast<Eigen::Index>(i);
      const double goal = std::isfinite(problem_.goal[k]) ? problem_.goal[k] : 0.0;
      const double nearer = q[k] - kTurn * std::round((q[k] - goal) / kTurn);
      if (nearer >= problem_.q_min[k] && nearer <= problem_.q_max[k]) q[k] = nearer;
    }
    return q;
  }

  ChainData chain_;
  const InverseProblem& problem_;
  Eigen::VectorXd at_rest_;
};

// Pseudo-random numbers in [0, 1), identical on all platforms.
class Sequence {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 1;
};

Eigen::VectorXd start(const ChainModel& chain, const InverseProblem& problem, int number,
                      Sequence& sequence) {
  Eigen::VectorXd q(problem.goal.size());
  for (int i = 0; i < q.size(); ++i) {
    const bool is_angle = !chain.joints()[i].is_slide();
    const Interval range = finite_range({problem.q_min[i], problem.q_max[i]}, is_angle);
    const double share = number < 2 ? 0.5 : sequence.next();
    q[i] = range.lb + share * (range.ub - range.lb);
    if (number == 0 && std::isfinite(problem.goal[i])) q[i] = problem.goal[i];
    q[i] = std::clamp(q[i], problem.q_min[i], problem.q_max[i]);
  }
  return q;
}

}  // namespace

InverseResult inverse_kinematics(const ChainModel& chain, const InverseProblem& problem) {
  Search search(chain, problem);
  Sequence sequence;
  InverseResult best;
  for (int number = 0; number < kStarts; ++number) {
    const InverseResult found = search.from(start(chain, problem, number, sequence));
    if (number == 0 || search.is_better(found, best)) best = found;
  }
  return best;
}

}  // namespace hg::model

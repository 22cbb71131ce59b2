#include "hg/identify/payload.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/core/cross.h"
#include "hg/core/interval.h"
#include "hg/core/linear_algebra.h"
#include "hg/identify/payload_units.h"

namespace hg::identify {
namespace {

constexpr double kGravity = 9.81;
// least variance of gravity's direction, about 6 degrees: less is not distinguishable from an
// offset
constexpr double kLeastSpread = 0.01;

// How gravity's direction varies in S: variances along three axes, the largest last.
struct Spread {
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

  explicit Spread(std::span<const StaticPose> poses) {
    if (poses.empty()) return;
    const double n = static_cast<double>(poses.size());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const StaticPose& pose : poses) mean += pose.a_S / n;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const StaticPose& pose : poses) {
      const Eigen::Vector3d u = (pose.a_S - mean) / kGravity;
      covariance += u * u.transpose() / n;
    }
    const SymmetricEigen eigen = symmetric_eigen(covariance);
    variance = eigen.values.cwiseMax(0.0);
    axes = eigen.vectors;
  }

  // information of the poses on the mass, and on the best and worst direction of its centre
  double of_mass() const { return variance.sum(); }
  double best() const { return variance[2] + variance[1]; }
  double worst() const { return variance[0] + variance[1]; }
  Eigen::Vector3d worst_axis() const { return axes.col(2); }
};

// Least squares A x = b; the rms of the residuals with the degrees of freedom that are left.
struct Fit {
  Eigen::VectorXd x;
  double residual = 0.0;

  Fit(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) : x(LeastSquares(A).solve(b)) {
    const auto free = static_cast<double>(std::max<Eigen::Index>(1, A.rows() - A.cols()));
    residual = std::sqrt((b - A * x).squaredNorm() / free);
  }
};

std::string missing_poses(const Spread& spread, std::size_t poses, const PayloadEstimate& result) {
  if (spread.of_mass() < kLeastSpread) {
    return "all poses hold the sensor alike: its weight cannot be distinguished from its offset; "
           "tilt it by "
           "30 degrees and more, about two axes";
  }
  if (spread.worst() < kLeastSpread) {
    const Eigen::Vector3d axis = spread.worst_axis();
    return fmt::format(
        "the centre of mass along the axis ({:.2f}, {:.2f}, {:.2f}) of S does not show: add poses "
        "turned about this axis by 30 degrees and more",
        axis.x(), axis.y(), axis.z());
  }
  if (poses < kFewestPoses) {
    return fmt::format("{} poses, at least {} are needed", poses, kFewestPoses);
  }
  constexpr double kCertain = 5.0;  // standard deviations
  if (result.mass < -kCertain * result.mass_deviation) {
    return fmt::format(
        "the mass is {:.3g} kg: a must be acceleration minus gravity, which at rest points up, and "
        "f the force on the sensor: one has the wrong sign",
        result.mass);
  }
  if (!(result.mass > 0.0)) return "no weight was measured: is there a payload, and is w_S in N?";
  if (result.mass_deviation > kMassAccuracy * result.mass || result.com_deviation > kComAccuracy) {
    return "the poses contradict each other: was the handle touched, did something move? "
           "Otherwise more poses help";
  }
  return "";
}

}  // namespace

PayloadEstimate identify_payload(std::span<const StaticPose> poses) {
  PayloadEstimate result;
  const Spread spread(poses);
  const auto n = static_cast<Eigen::Index>(poses.size());
  if (n > 0) {
    Eigen::MatrixXd A_f(3 * n, 4), A_n(3 * n, 6);
    Eigen::VectorXd f(3 * n), torque(3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const StaticPose& pose = poses[i];
      A_f.middleRows<3>(3 * i) << -pose.a_S, Eigen::Matrix3d::Identity();
      A_n.middleRows<3>(3 * i) << cross_matrix(pose.a_S), Eigen::Matrix3d::Identity();
      f.segment<3>(3 * i) = pose.w_S.head<3>();
      torque.segment<3>(3 * i) = pose.w_S.tail<3>();
    }
    const Fit force_fit(A_f, f), torque_fit(A_n, torque);
    result.mass = force_fit.x[0];
    if (result.mass != 0.0) result.com = torque_fit.x.head<3>() / result.mass;
    result.offset << force_fit.x.tail<3>(), torque_fit.x.tail<3>();
    result.force_residual = force_fit.residual;
    result.torque_residual = torque_fit.residual;
  }

  // a variance of gravity's direction in S is what n poses say about an unknown
  const auto deviation = [&](double residual, double variance) {
    if (variance < 1e-9) return kInfinity;
    return residual / (kGravity * std::sqrt(static_cast<double>(n) * variance));
  };
  result.mass_deviation = deviation(result.force_residual, spread.of_mass());
  result.com_deviation =
      deviation(result.torque_residual, spread.worst()) / std::max(1e-9, std::abs(result.mass));
  result.condition = spread.worst() < 1e-9 ? kInfinity : std::sqrt(spread.best() / spread.worst());
  result.missing = acceleration_fault(poses);
  if (result.missing.empty()) result.missing = missing_poses(spread, poses.size(), result);
  return result;
}

}  // namespace hg::identify

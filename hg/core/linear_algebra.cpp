#include "hg/core/linear_algebra.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

namespace hg {

struct LeastSquares::Decomposition {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> of;
};

LeastSquares::LeastSquares(const Eigen::MatrixXd& A, double threshold)
    : decomposition_(std::make_unique<Decomposition>()) {
  if (threshold > 0.0) decomposition_->of.setThreshold(threshold);
  decomposition_->of.compute(A);
}

LeastSquares::LeastSquares(LeastSquares&&) noexcept = default;
LeastSquares::~LeastSquares() = default;

Eigen::VectorXd LeastSquares::solve(const Eigen::VectorXd& b) const {
  return decomposition_->of.solve(b);
}

Eigen::MatrixXd LeastSquares::pseudo_inverse() const { return decomposition_->of.pseudoInverse(); }

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) { return A.inverse(); }

SingularValues singular_value_decomposition(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double spectral_radius(const Eigen::MatrixXd& A) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (!A.allFinite()) return kInfinite;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A, false);
  if (solver.info() != Eigen::Success) return kInfinite;
  return solver.eigenvalues().cwiseAbs().maxCoeff();
}

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& A) { return A.exp(); }

}  // namespace hg

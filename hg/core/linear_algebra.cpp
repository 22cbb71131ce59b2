#include "hg/core/linear_algebra.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

namespace hg {
namespace {

// Whether some x > 0 with |A| x < x is found: then the spectral radius is below 1, up to rounding
// (Collatz, Wielandt). Powers of |A| come near to such an x.
bool shrinks(const Eigen::MatrixXd& A) {
  constexpr int kPowers = 8;
  const Eigen::MatrixXd magnitudes = A.cwiseAbs();
  Eigen::VectorXd x = Eigen::VectorXd::Ones(A.cols());
  for (int i = 0; i < kPowers; ++i) {
    const Eigen::VectorXd next = magnitudes * x;
    if ((next.array() < x.array()).all()) return true;
    x = next / next.maxCoeff() + Eigen::VectorXd::Constant(A.cols(), 1e-9);
  }
  return false;
}

}  // namespace

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

bool has_decaying_powers(const Eigen::MatrixXd& A) {
  constexpr int kSquarings = 9;  // cheaper than the eigenvalues
  Eigen::MatrixXd power = A, square(A.rows(), A.cols());
  for (int i = 0; i < kSquarings && power.allFinite(); ++i) {
    if (shrinks(power)) return true;
    square.noalias() = power * power;
    power.swap(square);
  }
  return shrinks(power) || spectral_radius(A) < 1.0;
}

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& A) { return A.exp(); }

}  // namespace hg

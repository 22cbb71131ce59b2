/// Dense linear algebra on matrices of any size, for set-up, checks and experiments.
///
/// Decompositions are compiled here once instead of in every file that needs one. They allocate:
/// the control cycle uses fixed-capacity types instead.
#pragma once

#include <Eigen/Core>
#include <memory>

namespace hg {

/// Complete orthogonal decomposition of A (m x n) of any rank.
class LeastSquares {
 public:
  /// Decomposes A. Pivots below `threshold` times the largest count as zero; 0 = a few roundings.
  explicit LeastSquares(const Eigen::MatrixXd& A, double threshold = 0.0);
  LeastSquares(LeastSquares&&) noexcept;
  ~LeastSquares();

  /// Least-squares solution x (n) of A x = b with the smallest norm.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  /// Pseudoinverse of A (n x m).
  Eigen::MatrixXd pseudo_inverse() const;

 private:
  struct Decomposition;
  std::unique_ptr<Decomposition> decomposition_;
};

/// Inverse of a regular matrix.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);

/// Singular value decomposition A = U diag(sigma) V^T.
struct SingularValues {
  Eigen::VectorXd sigma;  ///< Singular values, largest first, min(rows, columns) of A
  Eigen::MatrixXd U, V;   ///< Left and right singular vectors as columns, one per value
};
SingularValues singular_value_decomposition(const Eigen::MatrixXd& A);

/// Eigenvalues of a symmetric matrix A, smallest first, and the eigenvectors as columns. Only the
/// lower triangle of A is read.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// Largest magnitude of an eigenvalue of a square matrix; infinity if the matrix is not finite.
double spectral_radius(const Eigen::MatrixXd& A);

/// Whether the powers of a square matrix vanish: spectral_radius(A) < 1, several times faster where
/// the radius is far below 1.
bool has_decaying_powers(const Eigen::MatrixXd& A);

/// Matrix exponential e^A.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& A);

}  // namespace hg

#include "hg/commissioning/identification/scaled_inverse.h"

#include <Eigen/Cholesky>

namespace hg::identification {

Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& H) {
  const Eigen::VectorXd scale = H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * H * scale.asDiagonal();
  return scale.asDiagonal() * scaled.ldlt().solve(Eigen::MatrixXd::Identity(H.rows(), H.cols())) *
         scale.asDiagonal();
}

}  // namespace hg::identification

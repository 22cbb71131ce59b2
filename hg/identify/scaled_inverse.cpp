#include "hg/identify/scaled_inverse.h"

#include <Eigen/Cholesky>

namespace hg::identify {

Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& H) {
  const Eigen::VectorXd scale = H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * H * scale.asDiagonal();
  return scale.asDiagonal() * scaled.ldlt().solve(Eigen::MatrixXd::Identity(H.rows(), H.cols())) *
         scale.asDiagonal();
}

}  // namespace hg::identify

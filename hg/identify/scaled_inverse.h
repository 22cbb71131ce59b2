/// Inverse of a normal matrix, such as that of a regression.
#pragma once

#include <Eigen/Core>

namespace hg::identify {

/// Inverse of a positive definite matrix whose rows are of any size.
Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& H);

}  // namespace hg::identify

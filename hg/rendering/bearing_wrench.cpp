#include "hg/rendering/bearing_wrench.h"

#include <algorithm>
#include <cmath>

namespace hg::rendering {

// Gram and Schmidt, always with the longest of the columns that are left; w is one more column.
Vector6 bearing_wrench(const model::Jacobian& J, const Vector6& w) noexcept {
  constexpr double kDependent = 1e-12;
  model::Jacobian left = J;
  Vector6 rest = w;
  double smallest_squared = 0.0;
  for (Eigen::Index rank = 0; rank < std::min<Eigen::Index>(6, J.cols()); ++rank) {
    Eigen::Index longest = 0;
    double squared = 0.0;
    for (Eigen::Index i = 0; i < left.cols(); ++i) {
      const double squared_i = left.col(i).squaredNorm();
      if (squared_i > squared) {
        squared = squared_i;
        longest = i;
      }
    }
    if (!(squared > smallest_squared)) break;
    if (rank == 0) smallest_squared = kDependent * kDependent * squared;
    const Vector6 direction = left.col(longest) / std::sqrt(squared);
    for (Eigen::Index i = 0; i < left.cols(); ++i) {
      left.col(i) -= direction * direction.dot(left.col(i));
    }
    left.col(longest).setZero();
    rest -= direction * direction.dot(rest);
  }
  return rest;
}

}  // namespace hg::rendering

#include "hg/controller/rendering/bearing_wrench.h"

#include <cmath>

namespace hg::rendering {

// Gram-Schmidt, always with the longest of the remaining columns; w is one more column.
Vector6 bearing_wrench(const model::Jacobian& J, const Vector6& w) noexcept {
  constexpr double kDependent = 1e-12;
  model::Jacobian left = J;
  Vector6 rest = w;
  double smallest_squared = 0.0;
  for (Eigen::Index count = left.cols(); count > 0; --count) {
    Eigen::Index longest = 0;
    double squared = 0.0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double squared_i = left.col(i).squaredNorm();
      if (squared_i > squared) {
        squared = squared_i;
        longest = i;
      }
    }
    if (!(squared > smallest_squared)) break;
    if (count == left.cols()) smallest_squared = kDependent * kDependent * squared;
    const Vector6 direction = left.col(longest) / std::sqrt(squared);
    left.col(longest) = left.col(count - 1);
    for (Eigen::Index i = 0; i < count - 1; ++i) {
      left.col(i) -= direction * direction.dot(left.col(i));
    }
    rest -= direction * direction.dot(rest);
  }
  return rest;
}

}  // namespace hg::rendering

#include "hg/model/coupling_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hg::model {
namespace {

// Curvatures of a cubic spline with given slopes at its ends: a tridiagonal system.
std::vector<double> curvatures_of(const std::vector<double>& y, double step, double first_slope,
                                  double last_slope) {
  const std::size_t n = y.size();
  std::vector<double> diagonal(n, 4.0), right(n), curvatures(n);
  diagonal.front() = diagonal.back() = 2.0;
  right.front() = 6.0 / step * ((y[1] - y[0]) / step - first_slope);
  right.back() = 6.0 / step * (last_slope - (y[n - 1] - y[n - 2]) / step);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    right[i] = 6.0 * (y[i + 1] - 2.0 * y[i] + y[i - 1]) / (step * step);
  }
  for (std::size_t i = 1; i < n; ++i) {  // all off the diagonal are 1
    diagonal[i] -= 1.0 / diagonal[i - 1];
    right[i] -= right[i - 1] / diagonal[i - 1];
  }
  curvatures[n - 1] = right[n - 1] / diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) {
    curvatures[i] = (right[i] - curvatures[i + 1]) / diagonal[i];
  }
  return curvatures;
}

}  // namespace

CouplingCurve::CouplingCurve(const Interval& range, std::vector<double> values, double first_slope,
                             double last_slope, bool is_periodic)
    : range_(range),
      step_((range.ub - range.lb) / static_cast<double>(values.size() - 1)),
      is_periodic_(is_periodic),
      values_(std::move(values)),
      curvatures_(curvatures_of(values_, step_, first_slope, last_slope)) {}

CouplingCurve::Point CouplingCurve::at(double q) const noexcept {
  double turns = 0.0, inside = q;
  if (is_periodic_) {
    turns = std::floor((q - range_.lb) / (range_.ub - range_.lb));
    inside = q - turns * (range_.ub - range_.lb);
  }
  inside = std::clamp(inside, range_.lb, range_.ub);
  const double place = (inside - range_.lb) / step_;
  const std::size_t i =
      std::min(static_cast<std::size_t>(place), values_.size() - 2);  // the point before it
  const double b = place - static_cast<double>(i), a = 1.0 - b;
  const double rise = values_[i + 1] - values_[i], m0 = curvatures_[i], m1 = curvatures_[i + 1];
  Point point;
  point.value = a * values_[i] + b * values_[i + 1] +
                step_ * step_ / 6.0 * ((a * a * a - a) * m0 + (b * b * b - b) * m1);
  point.slope = rise / step_ + step_ / 6.0 * ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1);
  point.curvature = a * m0 + b * m1;
  if (is_periodic_) {
    point.value += turns * (values_.back() - values_.front());
  } else if (q != inside) {
    point.value += point.slope * (q - inside);
    point.curvature = 0.0;
  }
  return point;
}

double CouplingCurve::steepest() const noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    most = std::max(most, std::abs(at(range_.lb + static_cast<double>(i) * step_).slope));
  }
  return most;
}

}  // namespace hg::model

#include "hg/controller/rendering/profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/text.h"

namespace hg::rendering {
namespace {

// Slope at a point between pieces of width h with mean slopes d: zero at an extremum.
double slope_between(double h_before, double d_before, double h_after, double d_after) noexcept {
  if (d_before * d_after <= 0.0) return 0.0;
  const double w_before = 2.0 * h_after + h_before;
  const double w_after = h_after + 2.0 * h_before;
  return (w_before + w_after) / (w_before / d_before + w_after / d_after);
}

// The cubic y + t (a + t (b + t c)), t = 0 .. 1, with these ends.
struct Cubic {
  double y, a, b, c;

  Cubic(double h, double y0, double y1, double slope0, double slope1) noexcept
      : y(y0),
        a(h * slope0),
        b(3.0 * (y1 - y0) - h * (2.0 * slope0 + slope1)),
        c(h * (slope0 + slope1) - 2.0 * (y1 - y0)) {}

  double at(double t) const noexcept { return y + t * (a + t * (b + t * c)); }
  double slope(double t) const noexcept { return a + t * (2.0 * b + 3.0 * c * t); }
};

}  // namespace

std::string profile_fault(const std::vector<ProfilePoint>& points, double repeat) {
  if (points.size() < 2 || points.size() > kMaxProfilePoints) {
    return "a profile needs 2 .. " + std::to_string(kMaxProfilePoints) + " points, got " +
           std::to_string(points.size());
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].q < points[i + 1].q) continue;
    return "positions must grow from point to point, got " + to_text(points[i + 1].q) + " after " +
           to_text(points[i].q);
  }
  const double length = points.back().q - points.front().q;
  if (length < repeat) return "";
  return "points must end before the first one repeats, at " + to_text(points.front().q + repeat) +
         ", got " + to_text(points.back().q);
}

Profile::Profile(const std::vector<ProfilePoint>& points, double repeat) : repeat_(repeat) {
  const std::string fault = profile_fault(points, repeat);
  if (!fault.empty()) throw SetupError(fault);
  std::vector<double> torque, friction;
  const auto add = [&](double q, const ProfilePoint& point) {
    q_.push_back(q);
    torque.push_back(point.torque);
    friction.push_back(point.friction);
  };
  for (const ProfilePoint& point : points) add(point.q, point);
  if (std::isfinite(repeat)) add(points.front().q + repeat, points.front());
  torque_ = curve(std::move(torque));
  friction_ = curve(std::move(friction));
  steepest_ = find_steepest();
}

Profile::Curve Profile::curve(std::vector<double> y) const {
  const std::size_t last = q_.size() - 1;
  std::vector<double> h, d;
  for (std::size_t i = 0; i < last; ++i) {
    h.push_back(q_[i + 1] - q_[i]);
    d.push_back((y[i + 1] - y[i]) / h[i]);
  }
  Curve curve = {std::move(y), std::vector<double>(last + 1)};
  for (std::size_t i = 1; i < last; ++i) {
    curve.slope[i] = slope_between(h[i - 1], d[i - 1], h[i], d[i]);
  }
  if (std::isfinite(repeat_)) {
    curve.slope.front() = curve.slope.back() =
        slope_between(h.back(), d.back(), h.front(), d.front());
  } else {
    curve.slope.front() = d.front();
    curve.slope.back() = d.back();
  }
  return curve;
}

double Profile::value(const Curve& curve, double q) const noexcept {
  if (std::isfinite(repeat_)) q -= repeat_ * std::floor((q - q_.front()) / repeat_);
  q = std::clamp(q, q_.front(), q_.back());
  const auto after = std::upper_bound(q_.begin() + 1, q_.end() - 1, q);
  const std::size_t i = after - q_.begin() - 1;
  const double h = q_[i + 1] - q_[i];
  return Cubic(h, curve.y[i], curve.y[i + 1], curve.slope[i], curve.slope[i + 1])
      .at((q - q_[i]) / h);
}

// at the ends of a piece, or where its slope has an extremum
double Profile::find_steepest() const noexcept {
  double steepest = 0.0;
  for (std::size_t i = 0; i + 1 < q_.size(); ++i) {
    const double h = q_[i + 1] - q_[i];
    const Cubic cubic(h, torque_.y[i], torque_.y[i + 1], torque_.slope[i], torque_.slope[i + 1]);
    const double extremum = cubic.c == 0.0 ? 0.0 : -cubic.b / (3.0 * cubic.c);
    for (const double t : {0.0, std::clamp(extremum, 0.0, 1.0), 1.0}) {
      steepest = std::max(steepest, std::abs(cubic.slope(t)) / h);
    }
  }
  return steepest;
}

}  // namespace hg::rendering

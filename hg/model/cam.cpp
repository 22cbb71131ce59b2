#include "hg/model/cam.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/text.h"

namespace hg::model {
namespace {

constexpr int kLeastPieces = 2048;  // of the curve, which has points at equal distances
constexpr double kSame = 1e-9;      // rad or m, of the two ends of a period

// The cubic spline through points at any distances. One that repeats has its first point again at
// the end.
class Spline {
 public:
  Spline(std::vector<CamPoint> points, bool repeats)
      : points_(std::move(points)), curvatures_(curvatures(repeats)) {}

  // value and slope at q within the points
  std::pair<double, double> at(double q) const {
    const auto above = std::ranges::upper_bound(points_, q, {}, &CamPoint::leader);
    const std::size_t i =
        std::clamp<std::ptrdiff_t>(above - points_.begin() - 1, 0, std::ssize(points_) - 2);
    const double h = width(i), b = (q - points_[i].leader) / h, a = 1.0 - b;
    const double y0 = points_[i].follower, y1 = points_[i + 1].follower;
    const double m0 = curvatures_[index(i)], m1 = curvatures_[index(i + 1)];
    return {a * y0 + b * y1 + h * h / 6.0 * ((a * a * a - a) * m0 + (b * b * b - b) * m1),
            (y1 - y0) / h + h / 6.0 * ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1)};
  }

  double middle_of_widest() const {
    std::size_t widest = 0;
    for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
      if (width(i) > width(widest)) widest = i;
    }
    return 0.5 * (points_[widest].leader + points_[widest + 1].leader);
  }

 private:
  double width(std::size_t i) const { return points_[i + 1].leader - points_[i].leader; }
  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

  double slope(std::size_t i) const {
    return (points_[i + 1].follower - points_[i].follower) / width(i);
  }

  // Slopes on both sides of each point agree; the curvatures at the ends are 0, or agree as well as
  // the slopes there.
  Eigen::VectorXd curvatures(bool repeats) const {
    const std::size_t last = points_.size() - 1;
    Eigen::MatrixXd A = Eigen::MatrixXd::Identity(index(last) + 1, index(last) + 1);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(index(last) + 1);
    const auto join = [&](std::size_t row, std::size_t before, std::size_t after) {
      A.row(index(row)).setZero();
      A(index(row), index(before)) += width(before);
      A(index(row), index(before + 1)) += 2.0 * width(before);
      A(index(row), index(after)) += 2.0 * width(after);
      A(index(row), index(after + 1)) += width(after);
      b[index(row)] = 6.0 * (slope(after) - slope(before));
    };
    for (std::size_t i = 1; i < last; ++i) join(i, i - 1, i);
    if (repeats) {
      join(0, last - 1, 0);
      A(index(last), 0) = -1.0;
    }
    return A.partialPivLu().solve(b);
  }

  std::vector<CamPoint> points_;
  Eigen::VectorXd curvatures_;
};

}  // namespace

std::string cam_fault(const std::vector<CamPoint>& points, double period) {
  const std::size_t least = std::isfinite(period) ? 3 : 2;
  if (points.size() < least || points.size() > kMaxCamPoints) {
    return "a cam needs " + std::to_string(least) + " .. " + std::to_string(kMaxCamPoints) +
           " points, got " + std::to_string(points.size());
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].leader < points[i + 1].leader) continue;
    return "positions of the leader must grow from point to point, got " +
           to_text(points[i + 1].leader) + " after " + to_text(points[i].leader);
  }
  const double length = points.back().leader - points.front().leader;
  if (length > period + kSame) {
    return "points must end where the first one repeats, at " +
           to_text(points.front().leader + period) + ", got " + to_text(points.back().leader);
  }
  const double gap = points.back().follower - points.front().follower;
  if (length < period - kSame || std::abs(gap) <= kSame) return "";
  return "a point where the first one repeats must be the same, expected " +
         to_text(points.front().follower) + ", got " + to_text(points.back().follower);
}

Cam make_cam(const std::vector<CamPoint>& points, double period) {
  const std::string fault = cam_fault(points, period);
  if (!fault.empty()) throw SetupError(fault);
  const bool repeats = std::isfinite(period);
  std::vector<CamPoint> all = points;
  if (repeats) {
    const CamPoint again = {points.front().leader + period, points.front().follower};
    if (again.leader - all.back().leader <= kSame) all.pop_back();
    all.push_back(again);
  }
  const Spline spline(all, repeats);
  // a turn begins in the middle of a piece: there no derivative jumps
  const double first = repeats ? spline.middle_of_widest() : all.front().leader;
  const double length = all.back().leader - all.front().leader;
  const auto at = [&](double share) {
    const double q = first + share * length;
    return spline.at(q > all.back().leader ? q - period : q);
  };

  // an even number for each piece, so that points at equal distances are all met
  const int pieces = static_cast<int>(all.size()) - 1;
  const int fine = 2 * pieces * ((kLeastPieces / 2 + pieces - 1) / pieces);
  std::vector<double> values;
  for (int i = 0; i <= fine; ++i) values.push_back(at(static_cast<double>(i) / fine).first);
  if (repeats) values.back() = values.front();
  const auto [least, most] = std::ranges::minmax(values);
  return {std::make_shared<CouplingCurve>(Interval{first, first + length}, std::move(values),
                                          at(0.0).second, at(1.0).second, repeats),
          {least, most}};
}

}  // namespace hg::model

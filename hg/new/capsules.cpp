#include "hg/new/capsules.h"

#include <algorithm>
#include <cmath>

#include "hg/core/interval.h"
#include "hg/core/linear_algebra.h"

namespace hg::new_files {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points corners_of(const std::vector<Triangle>& triangles) {
  Points points;
  points.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles) {
    points.insert(points.end(), triangle.begin(), triangle.end());
  }
  return points;
}

// the points that are outermost in directions all around: few, and nearly the same capsules fit
Points outermost(const Points& points) {
  constexpr int kDirections = 200;
  const double golden = M_PI * (3.0 - std::sqrt(5.0));
  Points found;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections;
    const double r = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d u(r * std::cos(golden * i), r * std::sin(golden * i), z);
    const auto far = std::ranges::max_element(points, {}, [&](const auto& p) { return u.dot(p); });
    if (std::ranges::find(found, *far) == found.end()) found.push_back(*far);
  }
  return found;
}

Eigen::Matrix3d principal_axes(const Points& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) spread += (p - mean) * (p - mean).transpose();
  return symmetric_eigen(spread).vectors;
}

// centre of a small circle around the points as seen along `u`: towards the farthest one, in
// shrinking steps
Eigen::Vector3d centre_along(const Points& points, const Eigen::Vector3d& u) {
  constexpr int kSteps = 80;
  Eigen::Vector3d centre = points.front();
  for (int step = 1; step <= kSteps; ++step) {
    Eigen::Vector3d farthest = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d away = (p - centre) - u.dot(p - centre) * u;
      if (away.squaredNorm() > farthest.squaredNorm()) farthest = away;
    }
    centre += farthest / (step + 1.0);
  }
  return centre;
}

// the smallest capsule around the points that has its axis through `centre` along `u`
Capsule around(const Points& points, const Eigen::Vector3d& centre, const Eigen::Vector3d& u) {
  double radius = 0.0;
  for (const Eigen::Vector3d& p : points) radius = std::max(radius, u.cross(p - centre).norm());
  double begin = kInfinity, end = -kInfinity;
  for (const Eigen::Vector3d& p : points) {
    const double along = u.dot(p - centre);
    const double aside = u.cross(p - centre).squaredNorm();
    const double cap = std::sqrt(std::max(0.0, radius * radius - aside));
    begin = std::min(begin, along + cap);
    end = std::max(end, along - cap);
  }
  if (begin > end) begin = end = 0.5 * (begin + end);
  return {centre + begin * u, centre + end * u, radius};
}

struct Fit {
  Eigen::Vector3d axis;
  Capsule capsule;
  double volume = kInfinity;
};

Fit fit_along(const Points& points, const Eigen::Vector3d& axis) {
  const Capsule capsule = around(points, centre_along(points, axis), axis);
  return {axis, capsule, volume_of(capsule)};
}

Fit best_principal(const Points& points) {
  const Eigen::Matrix3d axes = principal_axes(points);
  Fit best;
  for (int i = 0; i < 3; ++i) {
    const Fit fit = fit_along(points, axes.col(i));
    if (fit.volume < best.volume) best = fit;
  }
  return best;
}

Fit refined(const Points& points, Fit best) {
  for (double step = 0.4; step > 0.01;) {
    bool is_better = false;
    const Eigen::Vector3d x = best.axis.unitOrthogonal();
    const Eigen::Vector3d y = best.axis.cross(x);
    for (const Eigen::Vector3d& aside : {x, y, Eigen::Vector3d(-x), Eigen::Vector3d(-y)}) {
      const Fit fit = fit_along(points, (best.axis + step * aside).normalized());
      if (fit.volume >= best.volume) continue;
      best = fit;
      is_better = true;
    }
    if (!is_better) step *= 0.5;
  }
  return best;
}

}  // namespace

double distance_to(const Capsule& capsule, const Eigen::Vector3d& p) {
  const Eigen::Vector3d segment = capsule.to - capsule.from;
  const double length = segment.squaredNorm();
  const double share =
      length > 0.0 ? std::clamp((p - capsule.from).dot(segment) / length, 0.0, 1.0) : 0.0;
  return (p - capsule.from - share * segment).norm() - capsule.radius;
}

double volume_of(const Capsule& capsule) {
  const double section = M_PI * capsule.radius * capsule.radius;
  return section * ((capsule.to - capsule.from).norm() + 4.0 / 3.0 * capsule.radius);
}

Capsule fit_capsule(const std::vector<Triangle>& triangles) {
  constexpr double kDigit = 1e-4;
  const Points points = corners_of(triangles);
  const Points few = outermost(points);
  const Fit fit = refined(few, best_principal(few));
  Capsule capsule = around(points, fit.capsule.from, fit.axis);
  for (Eigen::Vector3d* end : {&capsule.from, &capsule.to}) {
    *end = (*end / kDigit).array().round() * kDigit;
  }
  // an end moves by less than one digit
  capsule.radius = (std::ceil(capsule.radius / kDigit) + 1.0) * kDigit;
  return capsule;
}

std::pair<std::vector<Triangle>, std::vector<Triangle>> split(
    const std::vector<Triangle>& triangles) {
  constexpr std::size_t kTried = 800;  // triangles by which a plane is judged
  constexpr int kPlanes = 8;           // across each axis
  const Eigen::Matrix3d axes = principal_axes(corners_of(triangles));
  const auto height = [](const Triangle& t, const Eigen::Vector3d& u) {
    return u.dot(t[0] + t[1] + t[2]) / 3.0;
  };
  const std::size_t stride = triangles.size() / kTried + 1;
  double least = kInfinity, best_plane = 0.0;
  Eigen::Vector3d best_axis = Eigen::Vector3d::UnitX();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d u = axes.col(i);
    Interval extent = {kInfinity, -kInfinity};
    for (const Triangle& t : triangles) {
      extent = {std::min(extent.lb, height(t, u)), std::max(extent.ub, height(t, u))};
    }
    for (int k = 2; k < kPlanes - 1; ++k) {
      const double plane = std::lerp(extent.lb, extent.ub, static_cast<double>(k) / kPlanes);
      std::array<std::vector<Triangle>, 2> parts;
      for (std::size_t n = 0; n < triangles.size(); n += stride) {
        parts[height(triangles[n], u) < plane ? 0 : 1].push_back(triangles[n]);
      }
      if (parts[0].empty() || parts[1].empty()) continue;
      const double volume = best_principal(outermost(corners_of(parts[0]))).volume +
                            best_principal(outermost(corners_of(parts[1]))).volume;
      if (volume >= least) continue;
      least = volume;
      best_plane = plane;
      best_axis = u;
    }
  }
  if (std::isinf(least)) return {triangles, {}};
  std::pair<std::vector<Triangle>, std::vector<Triangle>> parts;
  for (const Triangle& t : triangles) {
    (height(t, best_axis) < best_plane ? parts.first : parts.second).push_back(t);
  }
  return parts;
}

std::vector<Triangle> cut(const std::vector<Triangle>& triangles, double longest) {
  std::vector<Triangle> done;
  std::vector<Triangle> left = triangles;
  while (!left.empty()) {
    const Triangle t = left.back();
    left.pop_back();
    const auto edge = [&](int i) { return (t[(i + 1) % 3] - t[i]).norm(); };
    int i = 0;
    for (int k : {1, 2}) i = edge(k) > edge(i) ? k : i;
    if (!(edge(i) > longest)) {
      done.push_back(t);
      continue;
    }
    const Eigen::Vector3d middle = 0.5 * (t[i] + t[(i + 1) % 3]);
    left.push_back({t[i], middle, t[(i + 2) % 3]});
    left.push_back({middle, t[(i + 1) % 3], t[(i + 2) % 3]});
  }
  return done;
}

}  // namespace hg::new_files

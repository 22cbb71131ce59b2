#include "hg/controller/rendering/stops.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace hg::rendering {
namespace {

using Eigen::Vector3d;

// A point fixed to a link of the twin.
struct Point {
  Vector3d p, v, bias;  // position, velocity, acceleration at ddq_a = 0, in B
  Vector3d lever;       // from the origin of the link, in B
  int frame = -1;
};

Point point_on(const model::ChainData& chain, int frame, const Vector3d& p_link) noexcept {
  const Pose& T = chain.pose(frame);
  const Vector6& twist = chain.twist(frame);
  const Vector6& bias = chain.bias_acceleration(frame);
  const Vector3d lever = T.R * p_link, omega = twist.tail<3>();
  return {.p = T.p + lever,
          .v = twist.head<3>() + omega.cross(lever),
          .bias = bias.head<3>() + bias.tail<3>().cross(lever) + omega.cross(omega.cross(lever)),
          .lever = lever,
          .frame = frame};
}

// The acceleration towards the surface that a turning body has by itself counts in front of the
// surface. Inside it fades: where the lever is short and the device holds the end effector, only
// a faster turn could balance it, and would need more.
double counted(double bias, double distance) noexcept {
  constexpr double kFading = 5e-3;  // m
  return bias < 0.0 ? bias * std::clamp(1.0 + distance / kFading, 0.0, 1.0) : bias;
}

VectorA row_of(const model::ChainData& chain, const Point& point, const Vector3d& n) noexcept {
  const auto& J = chain.jacobian(point.frame);
  return J.topRows<3>().transpose() * n + J.bottomRows<3>().transpose() * point.lever.cross(n);
}

// The acceleration along `row` with which a point brakes when a force pushes it, so that the end
// effector keeps to `rating` and every joint to its own.
double rating_along(const TwinNow& twin, const VectorA& row, double rating) noexcept {
  constexpr double kFixed = 1e-12;  // 1/kg
  const auto factor = twin.L.triangularView<Eigen::Lower>();
  VectorA ddq = row;
  factor.solveInPlace(ddq);
  const double mobility = ddq.squaredNorm();
  if (mobility < kFixed) return rating;
  factor.transpose().solveInPlace(ddq);
  const Vector3d of_E = twin.chain.jacobian(twin.model.end_effector).topRows<3>() * ddq;
  double force = rating / std::max(mobility, of_E.cwiseAbs().maxCoeff());
  for (int i = 0; i < ddq.size(); ++i) {
    force = std::min(force, twin.model.dofs[i].limits.ddq_max / std::abs(ddq[i]));
  }
  return force * mobility;
}

// That along the motion of a point.
double rating_of(const TwinNow& twin, const Point& point, double rating) noexcept {
  const double speed = point.v.norm();
  if (speed == 0.0) return rating;
  return rating_along(twin, row_of(twin.chain, point, point.v / speed), rating);
}

Stop stop_of(const TwinNow& twin, const Point& point, const surfaces::Facing& facing, double radius,
             double rating) noexcept {
  const Vector3d& n = facing.normal;
  const VectorA row = row_of(twin.chain, point, n);
  return {.surface = facing.surface,
          .normal = n,
          .distance = facing.distance - radius,
          .speed = n.dot(point.v),
          .row = row,
          .bias = n.dot(point.bias),
          .rating = rating_along(twin, row, rating)};
}

// How far away it would come to rest, m.
double margin(const Stop& stop) noexcept {
  return stop.distance + stop.speed * std::abs(stop.speed) / (2.0 * stop.rating);
}

// Keeps the stops with the least margin, in their order.
void keep(const Stop& stop, std::span<Stop> kept) noexcept {
  const auto unused = std::ranges::find(kept, -1, &Stop::surface);
  auto last = unused;
  if (unused == kept.end()) {
    const auto farthest = std::ranges::max_element(kept, {}, margin);
    if (margin(*farthest) <= margin(stop)) return;
    std::rotate(farthest, farthest + 1, kept.end());
    last = kept.end() - 1;
  }
  *last = stop;
}

}  // namespace

int stop_count(const surfaces::Environment& environment, const TwinModel& twin) noexcept {
  if (!environment.has_stops()) return 0;
  return twin.spheres.empty() ? surfaces::kMostFacing : kMostStops;
}

Stops find_stops(const surfaces::Environment& environment, const TwinNow& twin,
                 double rating) noexcept {
  Stops stops;
  const Point E = point_on(twin.chain, twin.model.end_effector, Vector3d::Zero());
  const auto facing = environment.stops(E.p, E.v, rating_of(twin, E, rating));
  for (std::size_t i = 0; i < facing.size(); ++i) {
    if (facing[i].surface >= 0) stops[i] = stop_of(twin, E, facing[i], 0.0, rating);
  }
  const std::span<Stop> of_spheres = std::span(stops).subspan(surfaces::kMostFacing);
  for (const CollisionSphere& sphere : twin.model.spheres) {
    const Point point = point_on(twin.chain, sphere.frame, sphere.p);
    for (const surfaces::Facing& found :
         environment.stops(point.p, point.v, rating_of(twin, point, rating), sphere.radius)) {
      if (found.surface < 0) continue;
      Stop stop = stop_of(twin, point, found, sphere.radius, rating);
      stop.bias = counted(stop.bias, stop.distance);
      keep(stop, of_spheres);
    }
  }
  return stops;
}

}  // namespace hg::rendering

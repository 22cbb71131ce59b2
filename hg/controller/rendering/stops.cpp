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
  const Vector6 twist = chain.twist(frame), bias = chain.bias_acceleration(frame);
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

Stop stop_of(const model::ChainData& chain, const Point& point, const surfaces::Facing& facing,
             double radius) noexcept {
  const auto& J = chain.jacobian(point.frame);
  const Vector3d& n = facing.normal;
  const double distance = facing.distance - radius;
  return {
      .surface = facing.surface,
      .normal = n,
      .distance = distance,
      .speed = n.dot(point.v),
      .row = J.topRows<3>().transpose() * n + J.bottomRows<3>().transpose() * point.lever.cross(n),
      .bias = counted(n.dot(point.bias), distance)};
}

// How far away it would come to rest, m.
double margin(const Stop& stop, double rating) noexcept {
  return stop.distance + stop.speed * std::abs(stop.speed) / (2.0 * rating);
}

// Keeps the stops with the least margin, in their order.
void keep(const Stop& stop, double rating, std::span<Stop> kept) noexcept {
  const auto unused = std::ranges::find(kept, -1, &Stop::surface);
  auto last = unused;
  if (unused == kept.end()) {
    const auto farthest = std::ranges::max_element(
        kept, {}, [&](const Stop& other) { return margin(other, rating); });
    if (margin(*farthest, rating) <= margin(stop, rating)) return;
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

Stops find_stops(const surfaces::Environment& environment, const TwinModel& twin,
                 const model::ChainData& chain, const VectorA& dq_a, double rating) noexcept {
  Stops stops;
  const int E = twin.end_effector;
  const auto J = chain.jacobian(E).topRows<3>();
  const Vector3d v_E = J * dq_a, bias = chain.bias_acceleration(E).head<3>();
  const auto facing = environment.stops(chain.pose(E).p, v_E, rating);
  for (std::size_t i = 0; i < facing.size(); ++i) {
    if (facing[i].surface < 0) continue;
    const Vector3d& n = facing[i].normal;
    stops[i] = {.surface = facing[i].surface,
                .normal = n,
                .distance = facing[i].distance,
                .speed = n.dot(v_E),
                .row = J.transpose() * n,
                .bias = n.dot(bias)};
  }
  const std::span<Stop> of_spheres = std::span(stops).subspan(surfaces::kMostFacing);
  for (const CollisionSphere& sphere : twin.spheres) {
    const Point point = point_on(chain, sphere.frame, sphere.p);
    for (const surfaces::Facing& found :
         environment.stops(point.p, point.v, rating, sphere.radius)) {
      if (found.surface >= 0) {
        keep(stop_of(chain, point, found, sphere.radius), rating, of_spheres);
      }
    }
  }
  return stops;
}

}  // namespace hg::rendering

#include "hg/controller/rendering/stops.h"

#include <algorithm>
#include <cmath>

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

// The acceleration towards the surface that a turning body has without forces counts in front of
// the surface. Inside it fades: where the lever is short and the device holds the end effector,
// only a faster turn could balance it, and would need more.
double counted(double bias, double distance) noexcept {
  constexpr double kFading = 5e-3;  // m
  return bias < 0.0 ? bias * std::clamp(1.0 + distance / kFading, 0.0, 1.0) : bias;
}

VectorA row_of(const model::ChainData& chain, const Point& point, const Vector3d& n) noexcept {
  const auto& J = chain.jacobian(point.frame);
  return J.topRows<3>().transpose() * n + J.bottomRows<3>().transpose() * point.lever.cross(n);
}

// The acceleration along `row` with which all joints together brake a point that approaches with
// `speed`. A joint without ends can do all that it can; another one takes away its own part of the
// speed, since it may stand at its end before the point stands.
double rating_of_joints(const TwinNow& twin, const VectorA& row, double speed) noexcept {
  constexpr int kRounds = 4;  // the time to the stop and the help depend on each other
  double rating = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const double time = round > 0 && speed > 0.0 ? speed / rating : 0.0;
    rating = 0.0;
    for (int i = 0; i < row.size(); ++i) {
      if (row[i] == 0.0) continue;
      double help = twin.ddq_max[i];
      const bool has_ends = twin.model.dofs[i].limits.q_min > -kInfinity ||
                            twin.model.dofs[i].limits.q_max < kInfinity;
      if (has_ends && speed > 0.0) {
        const double own = row[i] > 0.0 ? -twin.dq[i] : twin.dq[i];  // towards the surface
        if (own <= 0.0) continue;
        if (time > 0.0) help = std::min(help, own / time);
      }
      rating += std::abs(row[i]) * help;
    }
    if (!(rating > 0.0 && rating < kInfinity)) break;
  }
  return rating;
}

// The acceleration along `row` with which a point that approaches with `speed` brakes when a force
// pushes it, so that the end effector keeps to `rating`, and with which all joints together can. A
// joint at its limit leaves the rest to the others.
double rating_along(const TwinNow& twin, const VectorA& row, double speed, double rating) noexcept {
  constexpr double kFixed = 1e-12;  // 1/kg
  constexpr double kLeast = 1e-3;   // m/s^2, where no joint can help
  const auto factor = twin.L.triangularView<Eigen::Lower>();
  VectorA ddq = factor.solve(row);
  const double mobility = ddq.squaredNorm();
  if (mobility < kFixed) return rating;
  ddq = factor.transpose().solve(ddq);
  const Vector3d of_E = twin.chain.jacobian(twin.model.end_effector).topRows<3>() * ddq;
  const double of_joints = std::max(kLeast, rating_of_joints(twin, row, speed));
  return std::min(rating * mobility / std::max(mobility, of_E.cwiseAbs().maxCoeff()), of_joints);
}

// That with which a point comes to rest along its motion, when each joint brakes as it can.
double rating_of(const TwinNow& twin, const Point& point, double rating) noexcept {
  const double speed = point.v.norm();
  if (speed == 0.0) return rating;
  const auto& J = twin.chain.jacobian(point.frame);
  double way = 0.0;
  for (int i = 0; i < twin.dq.size(); ++i) {
    const Vector3d along = J.col(i).head<3>() + Vector3d(J.col(i).tail<3>()).cross(point.lever);
    way += along.norm() * twin.dq[i] * twin.dq[i] / (2.0 * twin.ddq_max[i]);
  }
  const double of_E =
      rating_along(twin, row_of(twin.chain, point, -point.v / speed), speed, rating);
  return 1.0 / std::max(1.0 / of_E, 2.0 * way / (speed * speed));
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
          .rating = rating_along(twin, row, -n.dot(point.v), rating)};
}

}  // namespace

int stop_count(const surfaces::Environment& environment, const TwinModel& twin) noexcept {
  if (!environment.has_stops()) return 0;
  return (1 + static_cast<int>(twin.spheres.size())) * surfaces::kMostFacing;
}

Stops find_stops(const surfaces::Environment& environment, const TwinNow& twin,
                 double rating) noexcept {
  Stops stops;
  auto next = stops.begin();
  const auto add_stops_of = [&](const Point& point, double radius) {
    const auto planes = environment.stops(point.p, point.v, rating_of(twin, point, rating), radius);
    for (const surfaces::Facing& facing : planes) {
      if (facing.surface >= 0) *next = stop_of(twin, point, facing, radius, rating);
      ++next;
    }
  };
  add_stops_of(point_on(twin.chain, twin.model.end_effector, Vector3d::Zero()), 0.0);
  for (const CollisionSphere& sphere : twin.model.spheres) {
    const auto first = next;
    add_stops_of(point_on(twin.chain, sphere.frame, sphere.p), sphere.radius);
    std::for_each(first, next, [](Stop& stop) { stop.bias = counted(stop.bias, stop.distance); });
  }
  return stops;
}

}  // namespace hg::rendering

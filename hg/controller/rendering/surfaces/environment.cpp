#include "hg/controller/rendering/surfaces/environment.h"

#include <algorithm>
#include <string>
#include <utility>

#include "hg/core/error.h"

namespace hg::surfaces {
namespace {

using Eigen::Vector3d;

constexpr double kNear = 0.05;  // m; range of a stop, plus twice its braking distance
// m; depth down to which a mesh at least pushes back a point inside
constexpr double kDeepest = 0.2;
constexpr double kFlat = 1e-6;    // m; triangles that differ by less are coplanar or touch
constexpr double kStill = 1e-10;  // m; a proxy that moves less has arrived

// Contact force: never pulls, and its tangential part stays within the friction cone.
Vector3d force_of(const Spread& spread, double pressed, const Vector3d& velocity) noexcept {
  const double damping =
      spread.damping * std::min(1.0, spread.stiffness * spread.depth / kFullDamping);
  const double speed = velocity.dot(spread.normal);
  const double f_normal = std::max(0.0, spread.stiffness * pressed - damping * speed);
  const Vector3d v_tangent = velocity - speed * spread.normal;
  Vector3d f_tangent = spread.stiffness * spread.tangent - damping * v_tangent;
  const double held = spread.friction * f_normal;
  const double wanted = f_tangent.norm();
  if (wanted > held) f_tangent *= held / wanted;
  return f_normal * spread.normal + f_tangent;
}

// Whether a point behind a triangle of a mesh is outside the solid there: near a convex edge it is
// in front of another triangle of this solid, or less far behind it.
bool is_beside(const Surface& surface, const Vector3d& point, const Facing& behind) noexcept {
  const Mesh* mesh = std::get_if<Mesh>(&surface.shape);
  if (mesh == nullptr) return false;
  const Vector3d p = surface.pose.R.transpose() * (point - surface.pose.p);
  const Vector3d normal = surface.pose.R.transpose() * behind.normal;
  bool is_beside = false;
  mesh->for_each_near(p, p, kBehind, [&](const Triangle& triangle) {
    if (triangle.solid != behind.solid || !is_over(triangle, p, kFlat)) return;
    const double distance = triangle.normal.dot(p - triangle.corners[0]);
    if (distance > 0.0 ? distance >= kBehind : distance <= behind.distance) return;
    // inwards along the other triangle's plane, seen from the common edge, is behind this one
    const Vector3d middle = (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0;
    const double height = normal.dot(middle - (p - behind.distance * normal));
    if (height < -kFlat) is_beside = true;
  });
  return is_beside;
}

std::size_t count_stop_triangles(const std::vector<Surface>& surfaces) {
  std::size_t triangles = 0;
  for (const Surface& surface : surfaces) {
    const Mesh* mesh = std::get_if<Mesh>(&surface.shape);
    if (mesh != nullptr && surface.contact == Contact::kStop) triangles += mesh->triangles().size();
  }
  return triangles;
}

}  // namespace

void check_surfaces(const std::vector<Surface>& surfaces) {
  if (surfaces.size() > kMaxSurfaces) {
    throw SetupError("surfaces: at most " + std::to_string(kMaxSurfaces) + ", got " +
                     std::to_string(surfaces.size()));
  }
  for (const Surface& surface : surfaces) check_surface(surface);
  const std::size_t triangles = count_stop_triangles(surfaces);
  if (triangles > kMaxStopTriangles) {
    throw SetupError("surfaces that are stops: at most " + std::to_string(kMaxStopTriangles) +
                     " triangles in all, got " + std::to_string(triangles));
  }
}

Environment::Environment(std::vector<Surface> surfaces, double period, const Interval& mass)
    : surfaces_((check_surfaces(surfaces), std::move(surfaces))),
      mass_(mass),
      period_(period),
      has_stops_(std::ranges::any_of(
          surfaces_, [](const Surface& surface) { return surface.contact == Contact::kStop; })),
      stop_triangles_(count_stop_triangles(surfaces_)) {}

double Environment::damping_of(const Surface& surface, double mass_scale) const noexcept {
  if (surface.damping) return *surface.damping;
  return critical_damping(surface.stiffness, {mass_scale * mass_.lb, mass_scale * mass_.ub},
                          period_);
}

ContactReport Environment::step(const Vector3d& position, const Vector3d& velocity,
                                const Vector3d& push, EnvironmentState& state,
                                double mass_scale) const noexcept {
  const Vector3d handle = position + 0.5 * period_ * velocity;
  ContactReport contact;
  contact.proxy = handle;
  if (surfaces_.empty() || !handle.allFinite()) return contact;
  if (!state.is_started) state = {handle, true};
  Planes planes;
  follow(handle, mass_scale, planes, state.proxy);
  contact.proxy = state.proxy;
  const Spread spread = planes.spread(handle, state.proxy);
  contact.surface = spread.surface;
  if (spread.surface < 0) {
    state.dent = state.taken = state.pressed = 0.0;
    return contact;
  }
  state.dent = std::min(state.dent, spread.depth);
  state.pressed = spread.depth - state.dent;
  state.stiffness = spread.stiffness;
  contact.force = force_of(spread, state.pressed, velocity);
  if (spread.catches) catch_it(spread, mass_scale, velocity, push, contact, state);
  return contact;
}

// An impact is stopped with a time constant and no harder. So the spring balances the person's push
// at rest, and does not throw it back.
void Environment::catch_it(const Spread& spread, double mass_scale, const Vector3d& velocity,
                           const Vector3d& push, ContactReport& contact,
                           EnvironmentState& state) const noexcept {
  const double speed = -velocity.dot(spread.normal);
  if (speed < kImpact) return;
  const double most =
      std::max(0.0, -push.dot(spread.normal)) + mass_scale * mass_.ub * speed / kStopping;
  const double force = contact.force.dot(spread.normal);
  if (force <= most) return;
  contact.force *= most / force;
  const double pressed = std::min(state.pressed, most / spread.stiffness);
  state.dent += state.pressed - pressed;
  state.pressed = pressed;
}

void Environment::give_way(const ContactReport& contact, double missing, const Vector3d& velocity,
                           EnvironmentState& state) const noexcept {
  const double force = contact.force.norm();
  if (contact.surface < 0 || force == 0.0) return;
  const double given = std::max(0.0, force - missing);
  state.taken -= period_ * given * contact.force.dot(velocity) / force;
  state.taken = std::max(0.0, state.taken);
  if (missing > 0.0) {
    state.dent += std::min(missing / state.stiffness, state.pressed);
  } else if (state.taken > 0.5 * state.stiffness * state.pressed * state.pressed) {
    state.dent = std::max(0.0, state.dent - kRecovery * period_);
  }
}

std::array<Facing, kMostFacing> Environment::stops(const Vector3d& position,
                                                   const Vector3d& velocity, double ddq_max,
                                                   double radius) const noexcept {
  FacingPlanes planes;
  if (!position.allFinite() || !velocity.allFinite()) return planes.planes();
  const auto way = [&](double speed) { return speed * std::abs(speed) / (2.0 * ddq_max); };
  const double reach = radius + kNear + 2.0 * way(velocity.norm());
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (surfaces_[i].contact != Contact::kStop) continue;
    const Surface& surface = surfaces_[i];
    const auto add = [&](Facing found) {
      found.surface = static_cast<int>(i);
      if (found.is_edge && planes.covers(found)) return;
      if (found.distance < 0.0 && is_beside(surface, position, found)) return;
      planes.add(found, found.distance - way(-found.normal.dot(velocity)));
    };
    double nearest = std::max(reach, kDeepest);  // in front of the handle
    bool is_behind = false;
    for_each_facing(surface, position, reach, [&](const Facing& found) {
      if (found.distance < 0.0) is_behind = true;
      if (found.distance >= 0.0) nearest = std::min(nearest, found.distance);
      if (!found.is_edge) add(found);
    });
    const Mesh* mesh = std::get_if<Mesh>(&surface.shape);
    if (mesh == nullptr) continue;
    for_each_facing(surface, position, reach, [&](const Facing& found) {
      if (found.is_edge) add(found);
    });
    const Eigen::Matrix3d& R = surface.pose.R;
    const Vector3d p = R.transpose() * (position - surface.pose.p);
    if (is_behind || !mesh->extent().contains(p)) continue;
    Facing out = way_out(*mesh, p, mesh->is_one_solid() ? nearest : kDeepest);
    out.normal = R * out.normal;
    if (out.distance < 0.0) add(out);
  }
  return planes.planes();
}

Environment::Found Environment::first_hit(const Vector3d& from, const Vector3d& to) const noexcept {
  Found first;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (surfaces_[i].contact == Contact::kStop) continue;
    const auto hit = surfaces::first_hit(surfaces_[i], from, to);
    if (!hit || (first.surface >= 0 && hit->share >= first.hit.share)) continue;
    first = {*hit, static_cast<int>(i)};
  }
  return first;
}

// Follows the surface that the proxy meets on its way to the handle, and all it then meets. A round
// ends where the path is free; on a curved surface and behind an edge the next one starts from
// there. No planes: the proxy has reached the handle.
void Environment::follow(const Vector3d& handle, double mass_scale, Planes& planes,
                         Vector3d& proxy) const noexcept {
  for (int round = 0; round < kMaxRounds; ++round) {
    const Found met = first_hit(proxy, handle);
    planes = {};
    if (met.surface < 0) {
      proxy = handle;
      return;
    }
    const Vector3d before = proxy;
    proxy += met.hit.share * (handle - proxy);
    add(met, mass_scale, planes);
    slide(handle, mass_scale, planes, proxy);
    if ((proxy - before).norm() < kStill) return;
  }
}

bool Environment::add(const Found& met, double mass_scale, Planes& planes) const noexcept {
  const Surface& surface = surfaces_[met.surface];
  return planes.add(met.hit.normal, surface, damping_of(surface, mass_scale), met.surface);
}

void Environment::slide(const Vector3d& handle, double mass_scale, Planes& planes,
                        Vector3d& proxy) const noexcept {
  constexpr int kSweeps = kMaxSweeps / kMaxRounds - 1;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const Vector3d target = planes.step(handle, proxy);
    if ((target - proxy).norm() < kStill) return;
    const Found met = first_hit(proxy, target);
    proxy += met.hit.share * (target - proxy);
    if (met.surface < 0) return;
    if (!add(met, mass_scale, planes)) return;
  }
}

}  // namespace hg::surfaces

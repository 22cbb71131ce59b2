#include "hg/environment/environment.h"

#include <algorithm>
#include <string>
#include <utility>

#include "hg/core/error.h"

namespace hg::environment {
namespace {

using Eigen::Vector3d;

constexpr double kStill = 1e-10;  // m; a proxy that moves less has arrived

// Never pulls, and along the surface within the cone of friction.
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

}  // namespace

Environment::Environment(std::vector<Surface> surfaces, double period, const Interval& mass)
    : surfaces_(std::move(surfaces)), mass_(mass.ub), period_(period) {
  if (surfaces_.size() > kMaxSurfaces) {
    throw SetupError("surfaces: at most " + std::to_string(kMaxSurfaces) + ", got " +
                     std::to_string(surfaces_.size()));
  }
  for (const Surface& surface : surfaces_) {
    check(surface);
    damping_.push_back(surface.damping.value_or(critical_damping(surface.stiffness, mass, period)));
  }
}

ContactReport Environment::step(const Vector3d& position, const Vector3d& velocity,
                                const Vector3d& push, State& state) const noexcept {
  const Vector3d handle = position + 0.5 * period_ * velocity;
  ContactReport contact;
  contact.proxy = handle;
  if (surfaces_.empty() || !handle.allFinite()) return contact;
  if (!state.is_started) state = {handle, true};
  Planes planes;
  follow(handle, planes, state.proxy);
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
  if (spread.catches) catch_it(spread, velocity, push, contact, state);
  return contact;
}

// What comes in is stopped with a time constant and no harder. So the spring holds what the person
// pushes when it stands still, and does not throw it back.
void Environment::catch_it(const Spread& spread, const Vector3d& velocity, const Vector3d& push,
                           ContactReport& contact, State& state) const noexcept {
  const double speed = -velocity.dot(spread.normal);
  if (speed < kImpact) return;
  const double most = std::max(0.0, -push.dot(spread.normal)) + mass_ * speed / kStopping;
  const double force = contact.force.dot(spread.normal);
  if (force <= most) return;
  contact.force *= most / force;
  const double pressed = std::min(state.pressed, most / spread.stiffness);
  state.dent += state.pressed - pressed;
  state.pressed = pressed;
}

void Environment::give_way(const ContactReport& contact, double missing, const Vector3d& velocity,
                           State& state) const noexcept {
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

Environment::Found Environment::first_hit(const Vector3d& from, const Vector3d& to) const noexcept {
  Found first;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const auto hit = environment::first_hit(surfaces_[i], from, to);
    if (!hit || (first.surface >= 0 && hit->share >= first.hit.share)) continue;
    first = {*hit, static_cast<int>(i)};
  }
  return first;
}

// From the surface that the proxy meets on its way to the handle along that surface and whatever
// it then meets. A round ends where the way is free; on a curved surface and behind an edge the
// next one begins from there. No planes: the proxy has reached the handle.
void Environment::follow(const Vector3d& handle, Planes& planes, Vector3d& proxy) const noexcept {
  for (int round = 0; round < kMaxRounds; ++round) {
    const Found met = first_hit(proxy, handle);
    planes = {};
    if (met.surface < 0) {
      proxy = handle;
      return;
    }
    const Vector3d before = proxy;
    proxy += met.hit.share * (handle - proxy);
    const auto index = static_cast<std::size_t>(met.surface);
    planes.add(met.hit.normal, surfaces_[index], damping_[index], met.surface);
    slide(handle, planes, proxy);
    if ((proxy - before).norm() < kStill) return;
  }
}

void Environment::slide(const Vector3d& handle, Planes& planes, Vector3d& proxy) const noexcept {
  constexpr int kSweeps = kMaxSweeps / kMaxRounds - 1;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const Vector3d target = planes.step(handle, proxy);
    if ((target - proxy).norm() < kStill) return;
    const Found met = first_hit(proxy, target);
    proxy += met.hit.share * (target - proxy);
    if (met.surface < 0) return;
    const auto index = static_cast<std::size_t>(met.surface);
    if (!planes.add(met.hit.normal, surfaces_[index], damping_[index], met.surface)) return;
  }
}

}  // namespace hg::environment

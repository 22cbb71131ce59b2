#include "hg/teleoperation/model_mediated.h"

#include <algorithm>
#include <cmath>

#include "hg/core/interval.h"

namespace hg::teleoperation {
namespace {

constexpr int kInARow = 3;          // samples with a force that begin a contact, or end it
constexpr double kForget = 0.1;     // s, memory of the estimate
constexpr double kMoved = 5e-3;     // m or rad, a surface elsewhere is another one
constexpr double kGone = 0.05;      // s without a force behind it; a damped wall lags as it is left
constexpr double kTurned = 0.95;    // cosine, a surface that is turned is another one
constexpr double kStiffest = 5e4;   // N/m, as for virtual surfaces
constexpr double kSoftest = 50.0;   // N/m
constexpr double kChanged = 0.1;    // share of the stiffness that makes a new model
constexpr double kDamping = 0.35;   // share of critical damping of the rendered surface
constexpr double kRampForce = 2.0;  // N, damping grows with the spring's force up to here
constexpr double kShiftShare = 0.1;   // of the leader's speed by which its frame shifts back
constexpr double kClearance = 1e-3;   // m, kept to the surface meanwhile
constexpr double kShiftSpeed = 0.02;  // m/s, the same under load
constexpr double kSofter = 0.1;       // s, in which a surface becomes softer
constexpr double kSentSpeed = 1.0;    // m/s, so that it is no jump to the remote machine

}  // namespace

void ContactEstimator::start(Eigen::Index size) noexcept {
  model_ = {};
  model_.normal = PortVector::Zero(size);
  x_before_.resize(0);
  beyond_ = below_ = 0;
}

void ContactEstimator::step(const PortVector& x, const PortVector& v,
                            const PortVector& f) noexcept {
  const double force = f.norm();
  if (force < 0.2 * threshold_) x_before_ = x;
  beyond_ = force > threshold_ ? beyond_ + 1 : 0;
  below_ = force < 0.5 * threshold_ ? below_ + 1 : 0;
  if (beyond_ == 1) {
    x_first_ = x;
    force_first_ = force;
  }
  if (model_.is_touching && below_ >= kInARow) model_.is_touching = false;
  if (beyond_ >= kInARow && !model_.is_touching) begin(x, f);
  const double depth = model_.offset - model_.normal.dot(x);
  if (model_.is_touching) {
    refine(depth, -model_.normal.dot(v), f.dot(model_.normal));
  } else if (model_.stiffness > 0.0 && depth > kMoved && below_ * dt_ > kGone) {
    model_.stiffness = 0.0;  // the surface is gone
    ++model_.number;
  }
}

void ContactEstimator::begin(const PortVector& x, const PortVector& f) noexcept {
  const PortVector normal = f.normalized();
  const double offset = normal.dot(x_before_.size() == x.size() ? x_before_ : x);
  const bool is_known = model_.stiffness > 0.0 && model_.normal.dot(normal) > kTurned &&
                        std::abs(model_.offset - offset) < kMoved;
  model_.is_touching = true;
  if (is_known) return;
  ++model_.number;
  model_.normal = normal;
  model_.offset = offset;
  // the slope leaves out what a damper adds at the speed of the impact
  const double deeper = std::max(normal.dot(x_first_ - x), 1e-5);
  model_.stiffness = std::clamp((f.norm() - force_first_) / deeper, kSoftest, kStiffest);
  dd_ = dv_ = vv_ = df_ = vf_ = weight_ = 0.0;
  since_change_ = 0;
}

// Spring and damper through depth, speed and force, by least squares that forget.
void ContactEstimator::refine(double depth, double speed, double force) noexcept {
  const double keep = 1.0 - dt_ / kForget;
  weight_ = keep * weight_ + 1.0;
  dd_ = keep * dd_ + depth * depth;
  dv_ = keep * dv_ + depth * speed;
  vv_ = keep * vv_ + speed * speed;
  df_ = keep * df_ + depth * force;
  vf_ = keep * vf_ + speed * force;
  ++since_change_;
  constexpr double kDeepEnough = 2e-4;  // m, rms
  if (since_change_ * dt_ < kForget || dd_ < weight_ * kDeepEnough * kDeepEnough) return;
  constexpr double kStill = 1e-3;  // m/s: a damper counts beyond it
  const double vv = vv_ + weight_ * kStill * kStill;
  const double stiffness = (df_ * vv - vf_ * dv_) / (dd_ * vv - dv_ * dv_);
  if (!(stiffness > kSoftest && stiffness < kStiffest)) return;
  if (std::abs(stiffness - model_.stiffness) < kChanged * model_.stiffness) return;
  ++model_.number;
  model_.stiffness = stiffness;
  since_change_ = 0;
}

void ModelLeader::start(Eigen::Index size) noexcept {
  model_ = {};
  model_.normal = PortVector::Zero(size);
  stiffness_ = 0.0;
  shift_ = sent_ = PortVector::Zero(size);
  paid_ = dissipated_ = 0.0;
}

double ModelLeader::depth(const PortVector& x) const noexcept {
  return model_.stiffness > 0.0 ? model_.offset - model_.normal.dot(x + shift_) : 0.0;
}

// The new surface pushes with the force of the old one: the leader shifts instead of its hand.
void ModelLeader::take(const ContactModel& model, const PortVector& x) noexcept {
  const double force = std::max(0.0, model_.stiffness * depth(x));
  const bool is_same = model_.stiffness > 0.0 && model_.normal == model.normal;
  const double before = is_same ? model_.stiffness : 0.0;
  model_ = model;
  stiffness_ = model.stiffness;
  if (stiffness_ <= 0.0) return;
  model_.stiffness = std::max(stiffness_, before);
  const double excess = depth(x) - force / model_.stiffness;
  if (excess > 0.0) shift_ += excess * model_.normal;
}

// Takes the shift back: in free motion as the hand withdraws, the remote machine stays just in
// front of the surface; under load with energy that the port has taken.
void ModelLeader::restore(const LeaderPort& port, double force) noexcept {
  const double size = shift_.norm();
  if (size == 0.0) return;
  double step = 0.0;
  if (force > 0.0) {
    const double power = force * std::max(0.0, model_.normal.dot(shift_) / size);
    step = kShiftSpeed * dt_;
    const double left = port.energy.net() - paid_ - 0.5 * force * force / model_.stiffness;
    if (power * step > left) step = std::max(0.0, left) / power;
    paid_ += power * step;
  } else {
    const double speed = std::max(kShiftShare * port.v.norm(), shift_.dot(port.v) / size);
    const double room =
        model_.stiffness > 0.0 ? std::max(0.0, -depth(port.x) - kClearance) : kInfinity;
    step = std::min(speed * dt_, room);
  }
  shift_ *= 1.0 - std::min(1.0, step / size);
}

PortVector ModelLeader::step(const LeaderPort& port, const RemotePacket& arrived, bool /*is_new*/,
                             LeaderPacket& packet) noexcept {
  if (arrived.model.number != model_.number) take(arrived.model, port.x);
  model_.stiffness += (stiffness_ - model_.stiffness) * std::min(1.0, dt_ / kSofter);
  // where the leader will be in the middle of the period: the sampled spring then gains no energy
  const PortVector middle = port.x + 0.5 * dt_ * port.v;
  const double spring = model_.stiffness * std::max(0.0, depth(middle));
  double force = 0.0;
  if (spring > 0.0) {
    const double damping = 2.0 * kDamping * std::sqrt(model_.stiffness * mass_);
    const double v = model_.normal.dot(port.v);
    force = std::max(0.0, spring - damping * std::min(1.0, spring / kRampForce) * v);
  }
  restore(port, force);
  packet.model = model_.number;
  packet.f = force * model_.normal;
  const PortVector behind = shift_ - sent_;
  sent_ += behind * std::min(1.0, kSentSpeed * dt_ / std::max(behind.norm(), 1e-12));
  packet.x = port.x + sent_;
  return packet.f;
}

void ModelRemote::start(const PortVector& x) noexcept {
  contact_.start(x.size());
  dissipated_ = 0.0;
}

RemoteTarget ModelRemote::step(const RemotePort& port, const LeaderPacket& arrived, bool /*is_new*/,
                               RemotePacket& packet) noexcept {
  contact_.step(port.x, port.v, port.f);
  const ContactModel& model = contact_.model();
  packet.model = model;
  packet.reflected = port.f;
  RemoteTarget target = {arrived.x, arrived.v, PortVector::Zero(arrived.x.size())};
  if (model.stiffness <= 0.0) return target;
  const bool is_known = arrived.model == model.number;
  const double wanted = is_known ? std::max(0.0, arrived.f.dot(model.normal)) : config_.touch_force;
  // Position along the normal at which machine and surface press with that force: in contact from
  // where the machine is, else from where the surface is.
  const double along = model.normal.dot(target.x);
  const double surface =
      model.is_touching ? model.normal.dot(port.x) : model.offset - wanted / model.stiffness;
  const double pressed = surface - wanted / machine_.stiffness;
  const bool presses = model.is_touching && is_known && wanted > 0.0;
  if (along < pressed || presses) {
    target.x += (pressed - along) * model.normal;
    target.v -= model.normal.dot(target.v) * model.normal;
  }
  return target;
}

}  // namespace hg::teleoperation

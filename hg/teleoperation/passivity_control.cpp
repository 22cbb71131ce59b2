#include "hg/teleoperation/passivity_control.h"

#include <algorithm>
#include <cmath>

namespace hg::teleoperation {
namespace {

constexpr double kFastest = 10.0;  // most damping per mass, 1/s

// Largest share s <= 1 of a force that gives s a + s^2 b, with what it does to its own motion
// within the period, and no more than `available`.
double share_within(double a, double b, double available) noexcept {
  if (a + b <= available) return 1.0;
  return std::clamp((std::sqrt(a * a + 4.0 * b * available) - a) / (2.0 * b), 0.0, 1.0);
}

}  // namespace

void PassivityLeader::start(Eigen::Index /*size*/) noexcept { dissipated_ = 0.0; }

PortVector PassivityLeader::step(const LeaderPort& port, const RemotePacket& arrived,
                                 bool /*is_new*/, LeaderPacket& packet) noexcept {
  packet.energy = port.energy.taken;
  PortVector force = arrived.reflected;
  for (Eigen::Index i = 0; i < force.size(); ++i) {
    const double available = arrived.energy[i] - port.energy.given[i];
    const double v = port.v[i];
    const double share =
        share_within(force[i] * v * dt_, 0.5 * force[i] * force[i] * dt_ * dt_ / mass_,
                     std::max(available, 0.0));
    dissipated_ += (1.0 - share) * std::max(0.0, force[i] * v * dt_);
    force[i] *= share;
    // what the period before has given too much is taken back
    if (available < 0.0 && v != 0.0) {
      const double damping = std::min(-available / (dt_ * v * v), kFastest * mass_);
      dissipated_ += damping * v * v * dt_;
      force[i] -= damping * v;
    }
  }
  return force;
}

void PassivityRemote::start(const PortVector& /*x*/) noexcept { dissipated_ = 0.0; }

RemoteTarget PassivityRemote::step(const RemotePort& port, const LeaderPacket& arrived,
                                   bool /*is_new*/, RemotePacket& packet) noexcept {
  const Eigen::Index size = port.x.size();
  RemoteTarget target = {port.x_target, PortVector::Zero(size), PortVector::Zero(size)};
  packet.energy = port.energy.taken;
  packet.reflected = PortVector::Zero(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    double v = arrived.v[i] + correction_ * (arrived.x[i] - port.x_target[i]);
    const double spring = machine_.stiffness * (port.x_target[i] - port.x[i]);
    const double force = spring + machine_.damping * (v - port.v[i]);
    const double available = std::max(kAllowance + arrived.energy[i] - port.energy.given[i], 0.0);
    // the spring grows while the target moves
    const double gives = (force + 0.5 * machine_.stiffness * std::abs(v) * dt_) * v * dt_;
    if (gives > available) {
      const double share = available / gives;
      dissipated_ += (1.0 - share) * gives;
      v *= share;
    }
    packet.reflected[i] = -(spring + machine_.damping * (v - port.v[i]));
    target.v[i] = v;
    target.x[i] += v * dt_;
  }
  return target;
}

}  // namespace hg::teleoperation

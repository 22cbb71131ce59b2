#include "hg/teleoperation/wave_variables.h"

#include <algorithm>
#include <cmath>

namespace hg::teleoperation {

void WaveReservoir::start(Eigen::Index size) noexcept {
  left_ = PortVector::Zero(size);
  filled_ = taken_ = PortVector::Zero(size);
}

void WaveReservoir::fill(const PortVector& sent) noexcept {
  if (sent.size() != filled_.size()) return;
  for (Eigen::Index i = 0; i < sent.size(); ++i) {
    const double more = sent[i] - filled_[i];
    if (!(more > 0.0)) continue;
    left_[i] += more;
    filled_[i] = sent[i];
  }
}

PortVector WaveReservoir::use(const PortVector& wave, double dt) noexcept {
  PortVector used = PortVector::Zero(left_.size());
  if (wave.size() != left_.size()) return used;
  for (Eigen::Index i = 0; i < wave.size(); ++i) {
    const double needed = 0.5 * wave[i] * wave[i] * dt;
    const double left = std::max(0.0, left_[i]);
    const double share = needed > left ? std::sqrt(left / needed) : 1.0;
    used[i] = share * wave[i];
    left_[i] -= share * share * needed;
  }
  return used;
}

double WaveReservoir::pay(Eigen::Index i, double energy) noexcept {
  if (energy <= 0.0) return 1.0;
  const double share = std::clamp(left_[i] / energy, 0.0, 1.0);
  left_[i] -= share * energy;
  return share;
}

void WaveReservoir::settle(const PortVector& taken, const PortVector& expected) noexcept {
  left_ += taken - taken_ - expected;
  taken_ = taken;
}

void WaveLeader::start(Eigen::Index size) noexcept {
  reservoir_.start(size);
  sent_ = expected_ = PortVector::Zero(size);
  dissipated_ = 0.0;
}

PortVector WaveLeader::step(const LeaderPort& port, const RemotePacket& arrived, bool is_new,
                            LeaderPacket& packet) noexcept {
  reservoir_.settle(port.energy.taken - port.energy.given, expected_);
  if (is_new) reservoir_.fill(arrived.energy);
  const double root = std::sqrt(2.0 * b_);
  const PortVector w = reservoir_.use(arrived.wave, dt_);
  packet.wave = root * port.v - w;
  sent_ += 0.5 * dt_ * packet.wave.cwiseAbs2();
  packet.energy = sent_;
  const PortVector force = root * w - b_ * port.v;
  expected_ = -dt_ * force.cwiseProduct(port.v);
  dissipated_ = reservoir_.left();
  return force;
}

void WaveRemote::start(const PortVector& x) noexcept {
  reservoir_.start(x.size());
  sent_ = expected_ = PortVector::Zero(x.size());
  dissipated_ = 0.0;
}

// The target's velocity v + c follows from u, the force f_c of the machine's spring and damper, and
// the correction c towards the leader, which is paid with energy that was lost on the way:
//   b v = sqrt(2 b) u - f_c,   f_c = K (x_target - x) + B (v + c - v_x),
// solved for f_c.
RemoteTarget WaveRemote::step(const RemotePort& port, const LeaderPacket& arrived, bool is_new,
                              RemotePacket& packet) noexcept {
  reservoir_.settle(port.energy.taken - port.energy.given, expected_);
  if (is_new) reservoir_.fill(arrived.energy);
  const double b = config_.impedance;
  const double root = std::sqrt(2.0 * b);
  const double K = machine_.stiffness, B = machine_.damping;
  const Eigen::Index size = port.x.size();
  const PortVector u = reservoir_.use(arrived.wave, dt_);
  RemoteTarget target = {port.x_target, PortVector::Zero(size), PortVector::Zero(size)};
  packet.wave = packet.reflected = PortVector::Zero(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double spring = K * (port.x_target[i] - port.x[i]);
    const auto force_with = [&](double correction) {
      return (spring + B * (root * u[i] / b + correction - port.v[i])) / (1.0 + B / b);
    };
    double correction = config_.correction * (arrived.x[i] - port.x_target[i]);
    correction *= reservoir_.pay(i, force_with(correction) * correction * dt_);
    const double force = force_with(correction);
    const double v = (root * u[i] - force) / b + correction;
    packet.wave[i] = u[i] - std::sqrt(2.0 / b) * force;
    packet.reflected[i] = -force;
    expected_[i] = -force * v * dt_;
    target.v[i] = v;
    target.x[i] += v * dt_;
  }
  sent_ += 0.5 * dt_ * packet.wave.cwiseAbs2();
  packet.energy = sent_;
  dissipated_ = reservoir_.left();
  return target;
}

}  // namespace hg::teleoperation

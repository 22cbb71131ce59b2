#include "hg/teleoperation/remote_half.h"

#include <utility>

#include "hg/core/first_not_finite.h"

namespace hg::teleoperation {

RemoteHalf::RemoteHalf(std::unique_ptr<RemoteMethod> method, const MachineImpedance& machine,
                       const LimiterConfig& limiter, double dt)
    : impedance_(machine),
      dt_(dt),
      gate_((check_limiter(limiter), limiter)),
      limiter_(limiter, machine, dt),
      method_(std::move(method)) {}

void RemoteHalf::begin(std::unique_ptr<RemoteMethod> method) noexcept {
  method_ = std::move(method);
  gate_.forget();
  is_new_ = false;
  engagement_ = 0;
  sequence_ = 0;
}

void RemoteHalf::receive(const LeaderPacket& packet, double now_s) noexcept {
  is_new_ = gate_.take(packet, now_s) || is_new_;
}

PortVector RemoteHalf::coupling(const MachineState& machine,
                                const PortVector& x_target) const noexcept {
  return impedance_.stiffness * (x_target - machine.x) +
         impedance_.damping * (v_target_ - machine.v);
}

// Energy of the last period: the mean force of the machine's spring and damper along the target.
void RemoteHalf::observe(const MachineState& machine) noexcept {
  if (engagement_ == 0 || moved_.size() == 0) return;
  energy_.add(0.5 * (coupling_ + coupling(machine, x_target_)), moved_);
}

RemoteTarget RemoteHalf::step(double now_s, const MachineState& machine,
                              RemotePacket& packet) noexcept {
  const Eigen::Index size = machine.x.size();
  const bool is_measured = first_not_finite(machine.x, machine.v, machine.f) < 0;
  if (!has_position_) {
    x_target_ = machine.x;
    v_target_ = speed_ = PortVector::Zero(size);
    energy_.start(size);
    has_position_ = is_measured;
  }
  observe(machine);
  if (!is_measured) gate_.end(RemoteCause::kNotFinite);
  if (machine.has_stopped) gate_.end(RemoteCause::kStopped);
  const RemoteCause cause = gate_.check(now_s);
  if (machine.has_stopped && is_measured) {
    x_target_ = machine.x;
    speed_ = PortVector::Zero(size);
  }
  const LeaderPacket& arrived = gate_.newest();
  const bool follows = cause == RemoteCause::kNone && arrived.engagement != 0;
  if (follows && arrived.engagement != engagement_) {
    method_->start(x_target_);
    energy_.start(size);
    moved_.resize(0);
  }
  engagement_ = follows ? arrived.engagement : 0;

  packet = {.sequence = ++sequence_,
            .engagement = arrived.engagement,
            .sent_s = now_s,
            .answered_s = arrived.sent_s,
            .cause = cause,
            .x = machine.x,
            .v = machine.v,
            .x_target = x_target_,
            .f = machine.f,
            .reflected = PortVector::Zero(size),
            .wave = PortVector::Zero(size),
            .energy = energy_.taken};
  if (!has_position_) return {x_target_, v_target_, PortVector::Zero(size)};
  RemoteTarget wanted = {x_target_, PortVector::Zero(size), PortVector::Zero(size)};
  if (follows) {
    wanted = method_->step(
        {.x = machine.x, .v = machine.v, .f = machine.f, .x_target = x_target_, .energy = energy_},
        arrived, is_new_, packet);
    is_new_ = false;
  }
  const RemoteTarget target = limiter_.step(wanted, x_target_, speed_, packet.cause);
  moved_ = target.x - x_target_;
  speed_ = moved_ / dt_;
  v_target_ = target.v;
  coupling_ = coupling(machine, x_target_);
  x_target_ = target.x;
  packet.energy_net = energy_.net();
  packet.dissipated = method_->dissipated();
  return target;
}

}  // namespace hg::teleoperation

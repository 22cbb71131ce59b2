/// Time-domain passivity control of a link (Hannaford and Ryu 2002; time delay power networks of
/// Artigas, Ryu and Preusche 2010), with compensation of drift (Chawda and O'Malley 2014).
///
/// Velocity goes to the remote side, the force of the machine's coupling comes back. Packets carry
/// the energy that each port has taken so far; each half observes what it gives and gives no more
/// than what the other has said to have taken: the remote half slows its target, the leader's half
/// weakens the force and damps. That holds for any delay, jitter or loss.
///
/// A machine that has not moved sends no force, and the leader puts in no energy: the remote half
/// may give kAllowance once, to begin.
#pragma once

#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

/// Energy that each coordinate of the remote port may give before the leader has put some in, J.
inline constexpr double kAllowance = 0.02;

class PassivityLeader final : public LeaderMethod {
 public:
  PassivityLeader(const MethodConfig& config, double dt) : mass_(config.leader_mass), dt_(dt) {}
  void start(Eigen::Index size) noexcept override;
  PortVector step(const LeaderPort& port, const RemotePacket& arrived, bool is_new,
                  LeaderPacket& packet) noexcept override;

 private:
  double mass_, dt_;
};

class PassivityRemote final : public RemoteMethod {
 public:
  PassivityRemote(const MethodConfig& config, const MachineImpedance& machine, double dt)
      : correction_(config.correction), machine_(machine), dt_(dt) {}
  void start(const PortVector& x) noexcept override;
  RemoteTarget step(const RemotePort& port, const LeaderPacket& arrived, bool is_new,
                    RemotePacket& packet) noexcept override;

 private:
  double correction_;
  MachineImpedance machine_;
  double dt_;
};

}  // namespace hg::teleoperation

/// Wave variables (Anderson and Spong 1989, Niemeyer and Slotine 1991, 2004).
///
/// With the impedance b, velocity v of the leader and its force c against the link
///
///   u = (b v + c) / sqrt(2 b)   to the remote side,   w = (b v - c) / sqrt(2 b)   back,
///   c v = (u^2 - w^2) / 2:
///
/// the link stores what is on its way and creates nothing, however long that takes, as long as each
/// wave is used once. Packets therefore count the energy of the waves sent so far, and no half uses
/// more than what has arrived: a lost packet costs energy, a repeated one gives none.
///
/// The remote target also drifts to where the leader is, with energy that was lost on the way.
#pragma once

#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

/// Energy that has arrived as waves and was not used yet, coordinate by coordinate.
class WaveReservoir {
 public:
  void start(Eigen::Index size) noexcept;
  /// Adds what has arrived: the sum of all energy sent so far.
  void fill(const PortVector& sent) noexcept;
  /// The wave, or the part of it that the reservoir can pay for `dt`, which it pays.
  PortVector use(const PortVector& wave, double dt) noexcept;
  /// Pays up to `energy` of coordinate `i`; returns the share that was paid, 0..1.
  double pay(Eigen::Index i, double energy) noexcept;
  /// Books what the port has really taken since the last call, net and in all `taken`, where
  /// `expected` was reckoned with. What is missing is saved with the next waves.
  void settle(const PortVector& taken, const PortVector& expected) noexcept;
  double left() const noexcept { return left_.sum(); }

 private:
  PortVector left_, filled_, taken_;
};

class WaveLeader final : public LeaderMethod {
 public:
  WaveLeader(const MethodConfig& config, double dt) : b_(config.impedance), dt_(dt) {}
  void start(Eigen::Index size) noexcept override;
  PortVector step(const LeaderPort& port, const RemotePacket& arrived, bool is_new,
                  LeaderPacket& packet) noexcept override;

 private:
  double b_, dt_;
  WaveReservoir reservoir_;
  PortVector sent_;      ///< Energy of all waves sent, J
  PortVector expected_;  ///< What the port takes in this period, J
};

class WaveRemote final : public RemoteMethod {
 public:
  WaveRemote(const MethodConfig& config, const MachineImpedance& machine, double dt)
      : config_(config), machine_(machine), dt_(dt) {}
  void start(const PortVector& x) noexcept override;
  RemoteTarget step(const RemotePort& port, const LeaderPacket& arrived, bool is_new,
                    RemotePacket& packet) noexcept override;

 private:
  MethodConfig config_;
  MachineImpedance machine_;
  double dt_;
  WaveReservoir reservoir_;
  PortVector sent_, expected_;
};

}  // namespace hg::teleoperation

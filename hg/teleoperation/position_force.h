/// Position-force: positions go to the remote machine, the force that it measures comes back.
///
/// Also the four-channel architecture of Lawrence (1993): the force of the hand goes along, so that
/// both machines are accelerated alike, and a spring holds both positions together.
#pragma once

#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

class PositionForceLeader final : public LeaderMethod {
 public:
  void start(Eigen::Index size) noexcept override;
  PortVector step(const LeaderPort& port, const RemotePacket& arrived, bool is_new,
                  LeaderPacket& packet) noexcept override;
};

class PositionForceRemote final : public RemoteMethod {
 public:
  void start(const PortVector& x) noexcept override;
  RemoteTarget step(const RemotePort& port, const LeaderPacket& arrived, bool is_new,
                    RemotePacket& packet) noexcept override;
};

class FourChannelLeader final : public LeaderMethod {
 public:
  explicit FourChannelLeader(const MethodConfig& config) : config_(config) {}
  void start(Eigen::Index size) noexcept override;
  PortVector step(const LeaderPort& port, const RemotePacket& arrived, bool is_new,
                  LeaderPacket& packet) noexcept override;

 private:
  MethodConfig config_;
};

class FourChannelRemote final : public RemoteMethod {
 public:
  FourChannelRemote(const MethodConfig& config, const MachineImpedance& machine)
      : mass_ratio_(machine.mass / config.leader_mass) {}
  void start(const PortVector& x) noexcept override;
  RemoteTarget step(const RemotePort& port, const LeaderPacket& arrived, bool is_new,
                    RemotePacket& packet) noexcept override;

 private:
  double mass_ratio_;  ///< Of the machine and the leader
};

}  // namespace hg::teleoperation

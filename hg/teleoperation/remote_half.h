/// The side of the remote machine: what arrives, the method, the machine's own limits.
///
/// Needs nothing of the other side but its packets, so that it may run on the machine's computer.
/// One call of step() per period; receive() before it for each packet that has arrived. No
/// allocation after construction, noexcept.
#pragma once

#include <memory>

#include "hg/teleoperation/limiter.h"
#include "hg/teleoperation/machine.h"
#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

class RemoteHalf {
 public:
  /// Throws SetupError.
  RemoteHalf(const MethodConfig& method, const MachineImpedance& machine,
             const LimiterConfig& limiter, double dt)
      : RemoteHalf(make_remote_method(method, machine, dt), machine, limiter, dt) {}
  RemoteHalf(std::unique_ptr<RemoteMethod> method, const MachineImpedance& machine,
             const LimiterConfig& limiter, double dt);

  /// Another leader begins, by this method: the machine holds, with its target where it is.
  void begin(std::unique_ptr<RemoteMethod> method) noexcept;
  void receive(const LeaderPacket& packet, double now_s) noexcept;
  /// Target of the machine for the coming period, and the packet to send. The first position
  /// that is measured is its first target.
  RemoteTarget step(double now_s, const MachineState& machine, RemotePacket& packet) noexcept;

 private:
  PortVector coupling(const MachineState& machine, const PortVector& x_target) const noexcept;
  void observe(const MachineState& machine) noexcept;

  MachineImpedance impedance_;
  double dt_;
  PacketGate gate_;
  TargetLimiter limiter_;
  std::unique_ptr<RemoteMethod> method_;
  bool is_new_ = false;
  bool has_position_ = false;     ///< A position has been measured
  std::uint32_t engagement_ = 0;  ///< In which the machine follows; 0 = it holds
  std::uint64_t sequence_ = 0;
  PortVector x_target_, v_target_, moved_;  ///< Target, and its way in the last period
  PortVector speed_;                        ///< That way over the period
  PortVector coupling_;                     ///< At the begin of the last period
  PortEnergy energy_;
};

}  // namespace hg::teleoperation

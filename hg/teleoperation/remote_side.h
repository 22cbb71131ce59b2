/// The remote side of a teleoperation as the leader reaches it: its half of the method and its
/// machine, in this process or elsewhere.
///
/// Per period: send() for what has passed the simulated link, step() once, receive() until it has
/// nothing. None of them allocates or throws; they do not wait in real time.
#pragma once

#include "hg/teleoperation/machine.h"
#include "hg/teleoperation/remote_half.h"

namespace hg::teleoperation {

class RemoteSide {
 public:
  virtual ~RemoteSide() = default;
  /// Hands a packet over.
  virtual void send(const LeaderPacket& packet, double now_s) noexcept = 0;
  /// Lets a period pass.
  virtual void step(double now_s) noexcept = 0;
  /// Takes the next answer; false: there is none.
  virtual bool receive(RemotePacket& packet) noexcept = 0;
  /// True state of a machine that is simulated here; null = not known.
  virtual const MachineState* truth() const noexcept { return nullptr; }
};

/// In this process.
class SimulatedRemote final : public RemoteSide {
 public:
  /// Throws SetupError.
  SimulatedRemote(const MethodConfig& method, const LimiterConfig& limiter,
                  const SimulatedMachineConfig& machine, double dt)
      : half_(method, machine.impedance, limiter, dt), machine_(machine, dt) {}

  void send(const LeaderPacket& packet, double now_s) noexcept override {
    half_.receive(packet, now_s);
  }
  void step(double now_s) noexcept override {
    machine_.read(state_);
    const RemoteTarget target = half_.step(now_s, state_, answer_);
    // a protective stop ends when the leader lets go of the machine
    if (answer_.cause == RemoteCause::kReleased) machine_.free();
    machine_.write(target);
    has_answer_ = true;
  }
  bool receive(RemotePacket& packet) noexcept override {
    if (!has_answer_) return false;
    packet = answer_;
    has_answer_ = false;
    return true;
  }
  const MachineState* truth() const noexcept override { return &state_; }

 private:
  RemoteHalf half_;
  SimulatedMachine machine_;
  MachineState state_;
  RemotePacket answer_;
  bool has_answer_ = false;
};

}  // namespace hg::teleoperation

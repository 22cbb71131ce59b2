/// The side of a remote machine, for the program that drives it: its half of the method, its limits
/// and its watchdog, led over a network by one leader at a time
/// (docs/reference/device_protocol.md).
///
/// Whatever arrives, and whether or not anything does, the target stays within the limits. A new
/// leader must have been seen with its clutch open before it is followed.
#pragma once

#include <cstdint>
#include <string>

#include "hg/device/udp/session_host.h"
#include "hg/teleoperation/machine.h"
#include "hg/teleoperation/remote_half.h"
#include "hg/teleoperation/remote_udp/link.h"

namespace hg::teleoperation {

struct RemoteServerConfig {
  RemoteDescription description;
  MachineImpedance impedance;  ///< of the machine's own controller
  LimiterConfig limiter;
  std::string server;  ///< program and version, reported to the leader
  bool is_simulated = true;
  double session_silence_s = 5.0;  ///< after which another leader may come
  std::string capture;             ///< see udp::HostConfig
  udp::Key key;                    ///< shared key, which leaders must have, too
};

class RemoteServer {
 public:
  /// Throws SetupError.
  RemoteServer(const udp::Address& address, const RemoteServerConfig& config);
  ~RemoteServer();

  std::string address() const { return host_.address(); }
  std::string capture_error() { return host_.capture_error(); }

  /// Target for the coming period of a machine in this state. Real time: always, without waiting,
  /// to be called once per period. Lock-step: false after a moment without a period of the leader,
  /// in which the machine must stand still.
  bool step(const MachineState& state, RemoteTarget& target);

  bool has_leader() const noexcept { return host_.has_client(); }
  /// Why the machine did not follow in the last period.
  RemoteCause cause() const noexcept { return answer_.packet.cause; }
  /// What has happened since the last call, in lines, printable; empty: nothing.
  std::string news();
  /// Of the session.
  LinkCounts counts() const noexcept { return host_.counts(); }

 private:
  enum class Event { kNothing, kIgnored, kPeriod };
  Event hear();
  Event take(udp::MessageType type);
  void begin_session();
  void end_session(const udp::Goodbye& goodbye);
  void take_period();
  bool await_period();
  void note(const std::string& line);
  void note_changes();

  RemoteServerConfig config_;
  udp::SessionHost host_;
  RemoteHalf half_;
  udp::LeaderMessage arrived_;
  udp::RemoteMessage answer_;
  bool is_released_ = false;  ///< this leader was seen with its clutch open
  std::uint64_t period_ = 0;  ///< newest of this leader
  double time_s_ = 0.0;       ///< of that, by the leader
  std::int64_t began_ns_, heard_ns_ = 0;
  RemoteTarget target_;
  RemoteCause noted_ = RemoteCause::kReleased;
  std::string news_;
};

}  // namespace hg::teleoperation

/// A remote machine at the other end of a network, for the leader
/// (docs/reference/device_protocol.md).
///
/// The constructor connects, blocks and throws. In real time nothing else waits: a link that is
/// silent is asked for again, and a session that begins again counts as lost, so that the clutch
/// must be used. In lock-step step() waits for the machine.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hg/device/udp/session_guest.h"
#include "hg/signals/link_counts.h"
#include "hg/teleoperation/remote_side.h"
#include "hg/teleoperation/remote_udp/answer_gate.h"
#include "hg/teleoperation/remote_udp/link.h"

namespace hg::teleoperation {

struct UdpRemoteConfig {
  RemoteDescription description;
  MethodConfig method;
  std::string client;             ///< program and version, for the machine's log
  double answer_timeout_s = 3.0;  ///< time-out for the welcome
  double lock_step_timeout_s = 5.0;
  udp::Key key;  ///< shared key, which the machine must have, too
};

class UdpRemote final : public RemoteSide {
 public:
  /// Throws SetupError.
  UdpRemote(const udp::Address& address, const UdpRemoteConfig& config);
  UdpRemote(const UdpRemote&) = delete;
  UdpRemote& operator=(const UdpRemote&) = delete;
  ~UdpRemote() override;

  void send(const LeaderPacket& packet, double now_s) noexcept override;
  void step(double now_s) noexcept override;
  bool receive(RemotePacket& packet) noexcept override;

  LinkCounts counts() const noexcept { return guest_.counts(); }

 private:
  static constexpr std::size_t kRoom = 64;  ///< answers that wait
  void drain(double now_s) noexcept;
  void take(double now_s) noexcept;
  void give(const RemotePacket& packet, double now_s) noexcept;
  void say() noexcept;
  void await_answer(double now_s) noexcept;
  void look_for_machine() noexcept;
  void notice_session(double now_s) noexcept;

  UdpRemoteConfig config_;
  udp::SessionGuest guest_;
  AnswerGate gate_;
  udp::LeaderMessage message_;
  udp::RemoteMessage arrived_;
  RemotePacket passed_;
  std::uint64_t session_ = 1;
  bool has_begun_ = false;  ///< the machine has answered in this session
  bool is_gone_ = false;    ///< lock-step: the machine did not answer
  std::int64_t heard_ns_ = 0, terms_ns_ = 0, asked_ns_ = 0;
  double way_s_ = kInfinity;         ///< Least difference of both clocks at an arrival, s
  double round_trip_s_ = kInfinity;  ///< Least of the session, s
  double given_s_ = 0.0;             ///< RemotePacket::sent_s that was given last
  std::uint64_t given_ = 0;          ///< RemotePacket::sequence that was given last
  std::uint64_t numbered_from_ = 0;  ///< The same before this session; gaps stay gaps
  std::array<RemotePacket, kRoom> waiting_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace hg::teleoperation

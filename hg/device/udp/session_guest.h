/// The side of a session that asks: it says hello, and takes datagrams of its session only. What
/// they say is the business of its owner.
///
/// Single-threaded. All but the constructor neither wait nor throw.
#pragma once

#include <cstdint>
#include <string>

#include "hg/device/udp/address.h"
#include "hg/device/udp/inbox.h"
#include "hg/device/udp/key.h"
#include "hg/device/udp/outbox.h"
#include "hg/device/udp/protocol.h"
#include "hg/device/udp/session_host.h"
#include "hg/device/udp/udp_socket.h"
#include "hg/signals/link_counts.h"

namespace hg::udp {

struct GuestConfig {
  Description expected;           ///< any other is refused
  std::string what = "device";    ///< that is asked, in error messages
  std::string command;            ///< that serves it at an address, for error messages
  std::string client;             ///< program and version, for the host's log
  double answer_timeout_s = 3.0;  ///< time-out for the welcome
  double busy_patience_s = 0.0;   ///< time to keep asking one that has another client
  Key key;                        ///< shared key, which the host must have, too
};

class SessionGuest {
 public:
  /// Connects. Throws SetupError: no answer, refused and why, other description or version.
  SessionGuest(const Address& address, const GuestConfig& config);

  const Welcome& welcome() const noexcept { return welcome_; }

  /// Takes one datagram, if any waits.
  Heard hear(Header& header) noexcept;
  /// Decodes the message that was heard. False: it is malformed, which is counted.
  template <typename Message>
  [[nodiscard]] bool take(Message& message) noexcept {
    if (decode(datagram_.view(), message)) return true;
    ++malformed_;
    return false;
  }
  void count_malformed() noexcept { ++malformed_; }
  void count_foreign() noexcept { ++foreign_; }
  void wait(std::int64_t until_ns) noexcept { socket_.wait(until_ns); }
  /// When the datagram of the last hear() has come to this computer, ns of now_ns().
  std::int64_t arrived_ns() const noexcept { return socket_.arrived_ns(); }
  template <typename Message>
  void send(const Message& message) noexcept {
    socket_.send(outbox_.encode(message));
  }
  /// Says goodbye, several times: it is not acknowledged.
  void leave(const Goodbye& goodbye) noexcept;

  /// Says hello again, for a session after this one, which stays as it is until a welcome has been
  /// heard.
  void ask_again() noexcept;
  /// Counts sessions, from 1: a welcome begins the next one.
  std::uint64_t sessions() const noexcept { return sessions_; }

  /// Of this session.
  LinkCounts counts() const noexcept;

 private:
  enum class Answer { kNone, kJoined, kVersion, kForged, kBusy, kRefused, kUnlike };
  void connect(const std::string& at);
  bool is_joined(const std::string& at, bool is_patient);
  Answer answer(DatagramCheck verdict, const Header& header) noexcept;

  GuestConfig config_;
  UdpSocket socket_;
  Outbox outbox_;
  Inbox inbox_{0, Side::kServer};
  Welcome welcome_, heard_welcome_;
  std::uint64_t nonce_ = 0;
  bool is_asking_ = false;
  std::uint64_t sessions_ = 0;
  Datagram datagram_;
  std::uint64_t malformed_ = 0, foreign_ = 0;
};

}  // namespace hg::udp

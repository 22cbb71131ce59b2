/// The side of a session that is asked: it welcomes one client at a time, and takes datagrams of
/// this client only. What they say is the business of its owner.
///
/// Single-threaded. hear() and send() do not wait.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hg/device/udp/address.h"
#include "hg/device/udp/capture.h"
#include "hg/device/udp/inbox.h"
#include "hg/device/udp/key.h"
#include "hg/device/udp/outbox.h"
#include "hg/device/udp/protocol.h"
#include "hg/device/udp/udp_socket.h"
#include "hg/signals/link_counts.h"

namespace hg::udp {

struct HostConfig {
  Description actual;
  std::string what = "device";  ///< in texts to clients
  std::string server;           ///< program and version, reported to the client
  bool is_simulated = false;    ///< simulated device: its brakes need no test
  /// Time without a good message after which the session ends, reported to the client, s
  double silence_s = 0.05;
  /// Time between welcome and ready, in which the client sets itself up
  double ready_timeout_s = 30.0;
  MessageType begin = MessageType::kReady;  ///< by which a welcomed client begins its session
  std::string capture;  ///< file that receives every datagram, see Capture; empty = none
  Key key;              ///< shared key, which clients must have, too
};

/// What became of a datagram that waited.
enum class Heard {
  kNothing,  ///< none waited
  kIgnored,  ///< it is not for the owner
  kMessage,  ///< its message is to be decoded; without a client: it has begun a session
};

class SessionHost {
 public:
  /// Throws SetupError.
  SessionHost(const Address& address, const HostConfig& config);

  /// Listening address HOST:PORT, with the port that the system chose for 0.
  std::string address() const { return to_string(socket_.own_address()); }
  /// Why the capture misses datagrams; empty: it is complete, or there is none.
  std::string capture_error() { return capture_ ? capture_->flush() : ""; }

  /// Takes one datagram, if any waits.
  Heard hear(Header& header);
  /// Decodes the message that was heard. False: it is malformed, which is counted.
  template <typename Message>
  [[nodiscard]] bool take(Message& message) noexcept {
    if (decode(datagram_.view(), message)) return true;
    ++malformed_;
    return false;
  }
  /// Counts the message that was heard as malformed, or as of a wrong kind.
  void count_malformed() noexcept { ++malformed_; }
  void count_foreign() noexcept { ++foreign_; }
  bool was_overtaken() const noexcept { return inbox_.was_overtaken(); }
  void wait(std::int64_t until_ns) noexcept { socket_.wait(until_ns); }

  bool has_client() const noexcept { return has_client_; }
  /// Name and address, printable.
  std::string client() const;
  template <typename Message>
  void send(const Message& message) {
    send(message, outbox_, client_);
  }
  /// Says goodbye, where the client has not, and is free for the next one.
  void leave(const Goodbye& goodbye);
  void end_session() noexcept { has_client_ = false; }
  /// Forgets those that were welcomed and never began.
  void forget_late_candidates();

  /// Since the session began.
  LinkCounts counts() const noexcept;
  /// Address of the first other sender into this session; empty = none.
  std::string first_other() const { return from_others_ > 0 ? to_string(first_other_) : ""; }

 private:
  /// Client that is welcomed and has not begun yet. There may be several: the first that begins has
  /// the session, even when it is not among those remembered.
  struct Candidate {
    Peer peer;
    Hello hello;
    Outbox outbox;
    Inbox inbox;
    std::int64_t give_up_ns = 0;
  };
  Heard hear_client(DatagramCheck verdict, const Header& header, const Peer& from);
  Heard hear_candidate(DatagramCheck verdict, const Header& header, const Peer& from);
  void begin_session(const Candidate& chosen);
  Candidate& candidate_of(const Hello& hello, const Peer& from);
  std::uint32_t session_for(const Peer& peer, std::int64_t time_ns) const noexcept;
  bool was_welcomed(const Peer& peer, std::uint32_t session) const noexcept;
  void on_hello(const Header& header, DatagramCheck verdict, const Peer& from);
  void welcome(const Hello& hello, const Peer& from, bool is_client);
  void refuse(ConnectionRefusal refusal, const std::string& reason, std::uint64_t nonce,
              const Peer& to);
  template <typename Message>
  void send(const Message& message, Outbox& outbox, const Peer& to) {
    send_bytes(outbox.encode(message), to);
  }
  void send_bytes(std::span<const std::byte> datagram, const Peer& to);

  HostConfig config_;
  UdpSocket socket_;
  std::unique_ptr<Capture> capture_;
  /// Secret for session numbers: a client that answers with its number was welcomed at its address.
  std::array<unsigned char, 16> secret_{};
  std::uint64_t sessions_ = 0;         ///< number of sessions; a number is valid for one only
  std::vector<Candidate> candidates_;  ///< oldest first, one per address
  bool has_client_ = false;
  Peer client_;
  Hello hello_;
  Outbox outbox_{0};
  Inbox inbox_{0, Side::kClient};
  Datagram datagram_;
  std::uint64_t refused_ = 0, malformed_ = 0, foreign_ = 0, from_others_ = 0;
  Peer first_other_;
};

}  // namespace hg::udp

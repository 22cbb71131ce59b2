/// Serves a device to one client at a time: the other side of docs/reference/device_protocol.md.
///
/// Single-threaded. Real time: the device advances by this server's clock, with the newest command.
/// Lock-step: it advances by a period when the command that answers its last frame has arrived.
#pragma once

#include <sodium/crypto_shorthash.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hg/device/device.h"
#include "hg/device/udp/capture.h"
#include "hg/device/udp/inbox.h"
#include "hg/device/udp/outbox.h"
#include "hg/device/udp/protocol.h"
#include "hg/device/udp/udp_socket.h"
#include "hg/signals/link_counts.h"

namespace hg::udp {

/// Set-up data of a device server.
struct ServerConfig {
  Description actual;
  std::string server;         ///< program and version, reported to the client
  bool is_simulated = false;  ///< simulated device: its brakes need no test
  /// Real time: drives off after this time without a good command; a command that answers an older
  /// frame does not count.
  double command_timeout_s = 0.05;
  double lock_step_timeout_s = 5.0;
  /// Time between welcome and ready, in which the client sets itself up
  double ready_timeout_s = 30.0;
  std::string capture;  ///< file that receives every datagram, see Capture; empty = none
  Key key;              ///< shared key, which clients must have, too
};

enum class SessionEnd {
  kClientLeft,
  kClientSilent,  ///< no good command within the time-out
  kStopped,       ///< stopped by the caller
};

/// Summary of a session.
struct SessionReport {
  SessionEnd end = SessionEnd::kStopped;
  std::string client;         ///< name and address, printable
  std::string farewell;       ///< farewell text of the client, printable
  std::string other;          ///< address of the first other sender into this session; empty = none
  std::uint64_t periods = 0;  ///< periods for which the device advanced
  std::uint64_t overruns = 0;
  /// Time from a frame to the command that answers it
  double mean_answer_s = 0.0, max_answer_s = 0.0;
  LinkCounts link;
};

class DeviceServer {
 public:
  /// Throws SetupError.
  DeviceServer(const Address& address, const ServerConfig& config);

  /// Listening address HOST:PORT, with the port that the system chose for 0.
  std::string address() const { return to_string(socket_.own_address()); }

  /// Why the capture misses datagrams; empty: it is complete, or there is none.
  std::string capture_error() { return capture_ ? capture_->flush() : ""; }

  /// Blocks until a client has been welcomed and is ready. False: stopped by `stop`.
  bool wait_for_client(const std::atomic<bool>& stop);
  /// Runs the session of this client. However it ends, the last command disables the drives.
  SessionReport serve(device::Device& device, const std::atomic<bool>& stop);

 private:
  enum class Event { kNone, kReady, kCommand, kGoodbye };
  /// Client that is welcomed and not ready yet. There may be several: the first that is ready gets
  /// the device, even when it is not among those remembered.
  struct Candidate {
    Peer peer;
    Hello hello;
    Outbox outbox;
    Inbox inbox;
    std::int64_t give_up_ns = 0;
  };
  Event receive();
  Event hear(DatagramCheck verdict, const Header& header, const Peer& from);
  Event hear_candidate(DatagramCheck verdict, const Header& header, const Peer& from);
  void begin_session(const Candidate& chosen);
  Candidate& candidate_of(const Hello& hello, const Peer& from);
  std::uint32_t session_for(const Peer& peer, std::int64_t time_ns) const noexcept;
  bool was_welcomed(const Peer& peer, std::uint32_t session) const noexcept;
  Event take(const Header& header);
  void on_hello(const Header& header, DatagramCheck verdict, const Peer& from);
  void refuse(ConnectionRefusal refusal, const std::string& reason, std::uint64_t nonce,
              const Peer& to);
  void live_in_real_time(device::Device& device, const std::atomic<bool>& stop);
  void live_in_lock_step(device::Device& device, const std::atomic<bool>& stop);
  void close_session(bool is_stopped);
  bool answered(const std::atomic<bool>& stop);
  void measure_answer();
  template <typename Message>
  void send(const Message& message) {
    send(message, outbox_, client_);
  }
  template <typename Message>
  void send(const Message& message, Outbox& outbox, const Peer& to);
  void send_bytes(std::span<const std::byte> datagram, const Peer& to);

  ServerConfig config_;
  UdpSocket socket_;
  std::unique_ptr<Capture> capture_;
  /// Secret for session numbers: a client that answers with its number was welcomed at its address.
  std::array<unsigned char, crypto_shorthash_KEYBYTES> secret_{};
  std::uint64_t sessions_ = 0;         ///< number of sessions; a number is valid for one only
  std::vector<Candidate> candidates_;  ///< oldest first, one per address
  bool has_client_ = false;
  Peer client_;
  Hello hello_;
  Outbox outbox_{0};
  Inbox inbox_{0};
  Datagram datagram_;
  SensorFrame frame_;
  CommandFrame arrived_, command_;  ///< `command_` is in effect
  bool has_command_ = false;        ///< a command has arrived in this session
  bool has_left_ = false;           ///< the client has sent a goodbye
  std::int64_t frame_ns_ = 0, heard_ns_ = 0;
  std::int64_t answers_ = 0, answers_ns_ = 0, longest_answer_ns_ = 0;
  std::uint64_t refused_ = 0, late_ = 0, malformed_ = 0, foreign_ = 0, from_others_ = 0;
  Peer first_other_;
  SessionReport report_;
};

}  // namespace hg::udp

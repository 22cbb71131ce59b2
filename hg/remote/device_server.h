/// Serves a device to one client at a time: the other side of docs/device_protocol.md.
///
/// From one thread. Real time: the device lives by this server's clock, with the newest command.
/// Lock-step: it lives a period when the command that answers its last frame has come.
#pragma once

#include <sodium/crypto_shorthash.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hg/device/device.h"
#include "hg/remote/capture.h"
#include "hg/remote/inbox.h"
#include "hg/remote/outbox.h"
#include "hg/remote/protocol.h"
#include "hg/remote/udp_socket.h"
#include "hg/signals/link_counts.h"

namespace hg::remote {

/// Set-up data.
struct ServerConfig {
  Description actual;
  std::string server;         ///< program and version, for the client
  bool is_simulated = false;  ///< no machine moves: nobody has to test its brakes
  /// Real time: without a good command, drives off; one that answers an older frame is none.
  double command_timeout_s = 0.05;
  double lock_step_timeout_s = 5.0;
  double ready_timeout_s = 30.0;  ///< between welcome and ready: the client sets itself up
  std::string capture;            ///< every datagram into this file, see Capture; empty = none
  Key key;                        ///< that clients must have, too
};

enum class SessionEnd {
  kClientLeft,
  kClientSilent,  ///< no good command for the time-out
  kStopped,       ///< by the caller
};

/// What a session was like.
struct SessionReport {
  SessionEnd end = SessionEnd::kStopped;
  std::string client;         ///< name and address, printable
  std::string farewell;       ///< the client's, printable
  std::string other;          ///< address of the first that sent into this session; empty = none
  std::uint64_t periods = 0;  ///< that the device has lived
  std::uint64_t overruns = 0;
  double mean_answer_s = 0.0, max_answer_s = 0.0;  ///< from a frame to the command that answers it
  LinkCounts link;
};

class DeviceServer {
 public:
  /// Throws SetupError.
  DeviceServer(const Address& address, const ServerConfig& config);

  /// HOST:PORT, with the port that the system chose for 0.
  std::string address() const { return to_string(socket_.own_address()); }

  /// Why the capture does not hold every datagram so far; empty: it does, or there is none.
  std::string capture_error() { return capture_ ? capture_->flush() : ""; }

  /// Until a client has been welcomed and is ready. False: `stop` has come.
  bool wait_for_client(const std::atomic<bool>& stop);
  /// The session of this client. Whatever ends it, the last command disables the drives.
  SessionReport serve(device::Device& device, const std::atomic<bool>& stop);

 private:
  enum class Event { kNone, kReady, kCommand, kGoodbye };
  /// Welcomed and not ready yet. Several may be: the first that is ready has the device, also when
  /// it is not among those that are remembered.
  struct Candidate {
    Peer peer;
    Hello hello;
    Outbox outbox;
    Inbox inbox;
    std::int64_t give_up_ns = 0;
  };
  Event receive();
  Event hear(Verdict verdict, const Header& header, const Peer& from);
  Event hear_candidate(Verdict verdict, const Header& header, const Peer& from);
  void begin_session(const Candidate& chosen);
  Candidate& candidate_of(const Hello& hello, const Peer& from);
  std::uint32_t session_for(const Peer& peer, std::int64_t time_ns) const noexcept;
  bool was_welcomed(const Peer& peer, std::uint32_t session) const noexcept;
  Event take(const Header& header);
  void on_hello(const Header& header, Verdict verdict, const Peer& from);
  void refuse(Refusal refusal, const std::string& reason, std::uint64_t nonce, const Peer& to);
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
  /// Of the sessions' numbers: whoever answers with his has been welcomed at his address.
  std::array<unsigned char, crypto_shorthash_KEYBYTES> secret_{};
  std::uint64_t sessions_ = 0;         ///< that have begun: a number is for one only
  std::vector<Candidate> candidates_;  ///< the oldest first, one per address
  bool has_client_ = false;
  Peer client_;
  Hello hello_;
  Outbox outbox_{0};
  Inbox inbox_{0};
  Datagram datagram_;
  SensorFrame frame_;
  CommandFrame arrived_, command_;  ///< the latter is at work
  bool has_command_ = false;        ///< in this session
  bool has_left_ = false;           ///< the client has said goodbye
  std::int64_t frame_ns_ = 0, heard_ns_ = 0;
  std::int64_t answers_ = 0, answers_ns_ = 0, longest_answer_ns_ = 0;
  std::uint64_t refused_ = 0, late_ = 0, malformed_ = 0, foreign_ = 0, from_others_ = 0;
  Peer first_other_;
  SessionReport report_;
};

}  // namespace hg::remote

/// A connection to a robot that speaks the Franka Control Interface: TCP for commands and their
/// answers, UDP for states and torques.
///
/// The constructor and ask() block for a bounded time and throw; everything else neither blocks
/// (but wait()), allocates nor throws.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

#include "hg/device/franka/protocol.h"
#include "hg/device/udp/udp_socket.h"

namespace hg::franka {

/// Times after which set-up gives up, s.
struct Timeouts {
  double connect_s = 3.0;
  double answer_s = 3.0;
  double first_state_s = 1.0;
};

/// Answer to a command.
struct Answer {
  CommandHeader header;
  std::uint8_t status = 0;
  std::uint16_t version = 0;  ///< of the robot, in the answer to Connect
};

class Session {
 public:
  /// Connects and waits for the first state. Throws SetupError: no route, no answer, refused, other
  /// version, no state.
  Session(const udp::Address& address, const Timeouts& timeouts);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// HOST:PORT, for messages.
  const std::string& at() const noexcept { return at_; }

  /// Sends a command and waits for its answer. Throws SetupError that names `what` and the answer.
  template <typename Request>
  requires std::is_trivially_copyable_v<Request>
  void ask(Command command, const Request& request, const std::string& what) {
    await(command, send(command, request), what);
  }
  void ask(Command command, const std::string& what) { await(command, send(command, {}), what); }

  /// Sends a command; its number, 0 where it could not be sent.
  template <typename Request>
  requires std::is_trivially_copyable_v<Request> std::uint32_t send(Command command,
                                                                    const Request& request)
  noexcept { return send(command, std::as_bytes(std::span(&request, 1))); }
  std::uint32_t send(Command command, std::span<const std::byte> payload) noexcept;
  /// The oldest answer that has not been read; false: none.
  bool receive(Answer& answer) noexcept;
  /// Whether the robot has closed the connection, or has sent what is no answer.
  bool is_closed() const noexcept { return is_closed_; }

  /// The oldest state that has not been read; false: none.
  bool receive(RobotState& state) noexcept;
  /// When that state has come to this computer, ns of now_ns().
  std::int64_t arrived_ns() const noexcept { return socket_.arrived_ns(); }
  /// Waits until a datagram arrives, or until the given time of the monotonic clock.
  void wait(std::int64_t until_ns) noexcept { socket_.wait(until_ns); }
  void send(const RobotCommand& command) noexcept;

  /// Datagrams that were no states of this robot.
  std::uint64_t foreign() const noexcept { return foreign_; }

 private:
  void connect(const udp::Address& address, double timeout_s);
  void greet(double timeout_s);
  void await_first_state(double timeout_s);
  void await(Command command, std::uint32_t id, const std::string& what);
  bool await_answer(std::uint32_t id, double timeout_s, Answer& answer) noexcept;
  bool is_of_robot(const udp::Peer& from) const noexcept;
  void read_stream() noexcept;

  std::string at_;
  Timeouts timeouts_;
  int stream_ = -1;  ///< TCP
  udp::UdpSocket socket_;
  udp::Datagram datagram_;
  udp::Peer robot_;   ///< other end of the stream
  udp::Peer states_;  ///< where states come from
  bool has_states_ = false;
  std::uint64_t foreign_ = 0;
  std::uint32_t last_id_ = 0;
  std::array<std::byte, 256> answers_;  ///< bytes of answers that were not read
  std::size_t waiting_ = 0;             ///< number of those bytes
  bool is_closed_ = false;
};

}  // namespace hg::franka

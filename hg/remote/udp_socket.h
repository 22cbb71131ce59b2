/// Datagrams in and out.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <span>
#include <string>

#include "hg/remote/codec.h"
#include "hg/runtime/monotonic_clock.h"

namespace hg::remote {

/// HOST:PORT as a user types it; a host with colons in brackets.
struct Address {
  std::string host, port;
};

/// Throws SetupError that begins with `option`.
Address parse_address(const std::string& option, const std::string& text);

/// The other end of a datagram.
struct Peer {
  sockaddr_storage address{};
  socklen_t length = 0;
};
bool operator==(const Peer& a, const Peer& b) noexcept;
/// HOST:PORT in numbers.
std::string to_string(const Peer& peer);

using runtime::now_ns;

class UdpSocket {
 public:
  /// Throw SetupError that names the address and what the system says.
  static UdpSocket listening_at(const Address& address);
  static UdpSocket talking_to(const Address& address);
  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;
  ~UdpSocket();

  /// The following neither allocate nor block nor throw. What cannot be sent is lost.
  void send(std::span<const std::byte> datagram) noexcept;
  void send(std::span<const std::byte> datagram, const Peer& to) noexcept;
  /// The oldest datagram that waits; false: none. Longer ones are cut behind kLargestDatagram.
  bool receive(Datagram& datagram, Peer& from) noexcept;
  /// Until a datagram waits, or the time has come.
  void wait(std::int64_t until_ns) noexcept;

  /// Whether the other end's machine said that nobody listens there, since the last call.
  bool was_refused() noexcept;
  Peer own_address() const;

 private:
  explicit UdpSocket(int file) : file_(file) {}

  int file_;
  bool was_refused_ = false;
};

}  // namespace hg::remote

/// UDP socket for sending and receiving datagrams.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <span>
#include <string>

#include "hg/core/monotonic_clock.h"
#include "hg/device/udp/address.h"
#include "hg/device/udp/codec.h"

namespace hg::udp {

/// Address of the other end of a datagram.
struct Peer {
  sockaddr_storage address{};
  socklen_t length = 0;
};
bool operator==(const Peer& a, const Peer& b) noexcept;
/// Numeric HOST:PORT.
std::string to_string(const Peer& peer);

class UdpSocket {
 public:
  /// These throw SetupError that names the address and the system's error message.
  static UdpSocket listening_at(const Address& address);
  static UdpSocket talking_to(const Address& address);
  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;
  ~UdpSocket();

  /// Functions below neither allocate nor block nor throw. A datagram that cannot be sent is lost.
  void send(std::span<const std::byte> datagram) noexcept;
  void send(std::span<const std::byte> datagram, const Peer& to) noexcept;
  /// Receives the oldest waiting datagram; false: none. Longer ones are cut at kLargestDatagram.
  bool receive(Datagram& datagram, Peer& from) noexcept;
  /// When the datagram of the last receive() has come to this computer, by its system, ns of
  /// now_ns().
  std::int64_t arrived_ns() const noexcept { return arrived_ns_; }
  /// Waits until a datagram arrives, or until the given time.
  void wait(std::int64_t until_ns) noexcept;

  /// Whether the other machine has reported a closed port since the last call.
  bool was_refused() noexcept;
  Peer own_address() const;

 private:
  explicit UdpSocket(int file);

  int file_;
  std::int64_t arrived_ns_ = 0;
  bool was_refused_ = false;
};

}  // namespace hg::udp

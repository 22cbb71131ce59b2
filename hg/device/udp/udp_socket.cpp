#include "hg/device/udp/udp_socket.h"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "hg/core/error.h"

namespace hg::udp {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

std::string text_of(const Address& address) { return address.host + ":" + address.port; }

Addresses resolve(const Address& address, int flags) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
  if (error != 0) {
    throw SetupError(fmt::format("{}: no such host: {}", text_of(address), gai_strerror(error)));
  }
  return {found, &freeaddrinfo};
}

// the first of the addresses for which `attach` works
template <typename Attach>
int open_socket(const Address& address, int flags, const char* what, Attach attach) {
  const Addresses all = resolve(address, flags);
  int error = 0;
  for (const addrinfo* one = all.get(); one != nullptr; one = one->ai_next) {
    const int file = socket(one->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (file >= 0 && attach(file, one->ai_addr, one->ai_addrlen) == 0) return file;
    error = errno;
    if (file >= 0) close(file);
  }
  throw SetupError(
      fmt::format("{}: cannot {} there: {}", text_of(address), what, std::strerror(error)));
}

// When the datagram of this message has come, by a stamp of the system, whose clock may be set.
std::int64_t arrival_of(msghdr& message) noexcept {
  const std::int64_t now = now_ns();
  const cmsghdr* one = CMSG_FIRSTHDR(&message);
  if (one == nullptr || one->cmsg_level != SOL_SOCKET || one->cmsg_type != SCM_TIMESTAMPNS) {
    return now;
  }
  timespec stamp{}, clock{};
  std::memcpy(&stamp, CMSG_DATA(one), sizeof stamp);
  clock_gettime(CLOCK_REALTIME, &clock);
  const std::int64_t age =
      (clock.tv_sec - stamp.tv_sec) * kNanoseconds + clock.tv_nsec - stamp.tv_nsec;
  constexpr std::int64_t kLongest = 60 * kNanoseconds;  // more is a clock that was set
  return age < 0 || age > kLongest ? now : now - age;
}

}  // namespace

Address parse_address(const std::string& option, const std::string& text) {
  const auto refuse = [&] {
    throw SetupError(
        fmt::format("{}: expected HOST:PORT, for example 127.0.0.1:4810, got '{}'", option, text));
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) refuse();
  Address address{text.substr(0, colon), text.substr(colon + 1)};
  const bool has_brackets = address.host.starts_with('[') && address.host.ends_with(']');
  if (has_brackets) address.host = address.host.substr(1, address.host.size() - 2);
  if (address.host.empty() || (!has_brackets && address.host.find(':') != std::string::npos)) {
    refuse();
  }
  const bool is_number = !address.port.empty() && address.port.size() <= 5 &&
                         address.port.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number) refuse();
  if (std::stoi(address.port) > 65535) {
    throw SetupError(fmt::format("{}: a port is at most 65535, got '{}'", option, text));
  }
  return address;
}

bool operator==(const Peer& a, const Peer& b) noexcept {
  return a.length == b.length && std::memcmp(&a.address, &b.address, a.length) == 0;
}

std::string to_string(const Peer& peer) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  getnameinfo(reinterpret_cast<const sockaddr*>(&peer.address), peer.length, host.data(),
              host.size(), port.data(), port.size(), NI_NUMERICHOST | NI_NUMERICSERV);
  const bool is_v6 = peer.address.ss_family == AF_INET6;
  return is_v6 ? fmt::format("[{}]:{}", host.data(), port.data())
               : fmt::format("{}:{}", host.data(), port.data());
}

UdpSocket UdpSocket::listening_at(const Address& address) {
  return UdpSocket(open_socket(address, AI_PASSIVE, "listen", bind));
}

UdpSocket UdpSocket::talking_to(const Address& address) {
  return UdpSocket(open_socket(address, 0, "connect", connect));
}

UdpSocket::UdpSocket(int file) : file_(file) {
  const int on = 1;
  setsockopt(file, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

UdpSocket::~UdpSocket() {
  if (file_ >= 0) close(file_);
}

void UdpSocket::send(std::span<const std::byte> datagram) noexcept {
  const auto sent = ::send(file_, datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  was_refused_ = was_refused_ || (sent < 0 && errno == ECONNREFUSED);
}

void UdpSocket::send(std::span<const std::byte> datagram, const Peer& to) noexcept {
  sendto(file_, datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&to.address), to.length);
}

bool UdpSocket::receive(Datagram& datagram, Peer& from) noexcept {
  iovec bytes{.iov_base = datagram.bytes.data(), .iov_len = datagram.bytes.size()};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(timespec))> control;
  msghdr message{};
  message.msg_name = &from.address;
  message.msg_namelen = sizeof from.address;
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const auto size = recvmsg(file_, &message, MSG_DONTWAIT);
  was_refused_ = was_refused_ || (size < 0 && errno == ECONNREFUSED);
  if (size >= 0) {
    from.length = message.msg_namelen;
    arrived_ns_ = arrival_of(message);
  }
  datagram.size = size > 0 ? size : 0;
  return size >= 0;
}

void UdpSocket::wait(std::int64_t until_ns) noexcept {
  const std::int64_t left = until_ns - now_ns();
  if (left <= 0) return;
  pollfd one{.fd = file_, .events = POLLIN, .revents = 0};
  const timespec time{.tv_sec = left / kNanoseconds, .tv_nsec = left % kNanoseconds};
  ppoll(&one, 1, &time, nullptr);
}

bool UdpSocket::was_refused() noexcept { return std::exchange(was_refused_, false); }

Peer UdpSocket::own_address() const {
  Peer own;
  own.length = sizeof own.address;
  getsockname(file_, reinterpret_cast<sockaddr*>(&own.address), &own.length);
  return own;
}

}  // namespace hg::udp

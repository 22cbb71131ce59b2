/// Numbers and stamps the datagrams of one session.
#pragma once

#include "hg/device/udp/codec.h"
#include "hg/device/udp/udp_socket.h"

namespace hg::udp {

class Outbox {
 public:
  explicit Outbox(std::uint32_t session, const Key& key = {}) : session_(session), key_(key) {}

  /// Encodes a message with the next number; the bytes are valid until the next call.
  template <typename Message>
  std::span<const std::byte> encode(const Message& message) noexcept {
    const Header header{
        .session = session_, .number = ++number_, .time_ns = static_cast<std::uint64_t>(now_ns())};
    udp::encode(header, message, datagram_, key_);
    return datagram_.view();
  }
  /// Number of datagrams encoded so far.
  std::uint64_t number() const noexcept { return number_; }
  /// Sets the session of all further datagrams; numbering continues.
  void join(std::uint32_t session) noexcept { session_ = session; }

 private:
  std::uint32_t session_;
  Key key_;
  std::uint64_t number_ = 0;
  Datagram datagram_;
};

}  // namespace hg::udp

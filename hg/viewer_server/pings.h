/// Measures how long the way to a page and back takes: by pings, which browsers answer by
/// themselves, in order with the messages.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "hg/viewer_server/hub.h"

namespace hg::viewer_server {

class Pings {
 public:
  /// Sends one over `socket`, which belongs to `owner`, unless one is under way or was of late.
  template <typename Socket, typename Owner>
  void send(Socket& socket, std::shared_ptr<Owner> owner) {
    const double now = now_s();
    if (is_under_way_ || now < sent_s_ + kPeriod_s) return;
    is_under_way_ = true;
    sent_s_ = now;
    const std::string number = std::to_string(++count_);
    socket.async_ping({number.data(), number.size()}, [owner = std::move(owner)](error_code) {});
  }
  /// Hears the answers. From now on pings come between messages, not between parts of one.
  template <typename Socket>
  void listen(Socket& socket, Hub& hub) {
    socket.auto_fragment(false);
    socket.control_callback([this, &hub](websocket::frame_type kind, beast::string_view content) {
      if (kind == websocket::frame_type::pong && hear(view(content))) hub.note_round_trip();
    });
  }
  /// Of the last answer, s; NaN: none has come.
  double round_trip_s() const { return round_trip_s_; }

 private:
  // false: not an answer to the ping that is under way
  bool hear(std::string_view content) {
    if (!is_under_way_ || content != std::to_string(count_)) return false;
    is_under_way_ = false;
    round_trip_s_ = now_s() - sent_s_;
    return true;
  }
  static constexpr double kPeriod_s = 0.25;
  bool is_under_way_ = false;
  std::uint64_t count_ = 0;
  double sent_s_ = 0.0;
  double round_trip_s_ = kUnknown;
};

}  // namespace hg::viewer_server

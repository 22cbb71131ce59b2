/// One client of the live interface: sends messages of the run to it, reads its frames. The
/// protocol itself is in hg/live/session.h.
#pragma once

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hg/live/session.h"
#include "hg/viewer_server/hub.h"
#include "hg/viewer_server/message_rate.h"

namespace hg::viewer_server {

constexpr std::size_t kMostData = 1u << 20;     // bytes of messages that wait for a slow client
constexpr std::size_t kMostAnswers = 8u << 20;  // bytes of other frames; more: it is gone
constexpr double kFrameRate_Hz = 500.0;         // accepted frames
constexpr double kOrderRate_Hz = 200.0;         // a file of parameters comes at once
constexpr double kBytesPerSecond = 1 << 20;     // of frames that are read

/// Connection of one client; destroyed when it closes.
class LiveClient : public std::enable_shared_from_this<LiveClient> {
 public:
  /// `connection` and `place` are its shares of what the hub has, until it closes.
  LiveClient(Hub& hub, beast::tcp_stream&& stream, std::shared_ptr<int> connection,
             std::shared_ptr<int> place)
      : hub_(hub),
        socket_(std::move(stream)),
        pause_(socket_.get_executor()),
        connection_(std::move(connection)),
        place_(std::move(place)),
        session_(hub.board) {}

  void start(const Request& request, std::string_view protocol) {
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout{kRequestTimeout, kRequestTimeout, true});
    socket_.read_message_max(live::kLargestFrame);
    socket_.set_option(websocket::stream_base::decorator(
        [name = std::string(protocol)](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, name);
        }));
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->hub_.join(self);
      self->answer(self->session_.greeting());
      self->read();
    });
  }

  bool wants(std::size_t channel) const { return session_.wants(channel); }

  /// Queues a message; the oldest ones are dropped when the client is too slow for them.
  void show(const live::Message& message) {
    if (wants(message.channel)) show(session_.frame_of(message));
  }

  void show(live::Frame frame) {
    data_bytes_ += frame.size();
    data_.push_back(std::move(frame));
    while (data_bytes_ > kMostData && data_.size() > 1) {
      data_bytes_ -= data_.front().size();
      data_.pop_front();
      ++lost_;
      ++hub_.dropped;
    }
    write();
  }

  void answer(std::vector<live::Frame> frames) {
    for (live::Frame& frame : frames) {
      answer_bytes_ += own_bytes(frame);
      answers_.push_back(std::move(frame));
    }
    if (answer_bytes_ > kMostAnswers) return beast::get_lowest_layer(socket_).close();
    write();
  }

  /// Passes on the answer to a command of this client.
  void answer(double id, std::string_view refusal) { answer(session_.answer(id, refusal).frames); }

  void send_changes(const std::vector<std::string>& parameters) {
    answer(session_.changed_parameters(parameters));
  }

  std::uint64_t number = 0;

 private:
  /// Memory of an answer: its payload is shared with all who get it.
  static std::size_t own_bytes(const live::Frame& frame) {
    return sizeof frame + frame.head.size();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t size) {
      if (error) {
        if (error == websocket::error::message_too_big) ++self->hub_.refused;
        self->hub_.leave(self);
        return;
      }
      const double pause_s = self->byte_rate_.charge(static_cast<double>(size), now_s());
      self->listen();
      self->read_after(pause_s);
    });
  }

  /// Reading costs the server time that all share: who sends too much is read later.
  void read_after(double pause_s) {
    if (pause_s <= 0.0) return read();
    pause_.expires_after(std::chrono::microseconds(static_cast<std::int64_t>(1e6 * pause_s)));
    pause_.async_wait([self = shared_from_this()](error_code) { self->read(); });
  }

  void listen() {
    const auto bytes = buffer_.cdata();
    const std::string_view frame(static_cast<const char*>(bytes.data()), bytes.size());
    live::Reaction reaction = session_.take(frame, socket_.got_text());
    buffer_.clear();
    hub_.note_wanted();
    for (const live::Order& order : reaction.orders) {
      if (const auto refusal = hub_.take(command_of(order), order_rate_))
        answer(order.id, *refusal);
    }
    if (reaction.is_refused) ++hub_.refused;
    if (!rate_.admit(now_s())) {
      ++hub_.refused;  // without an answer, which would only amplify a flood
      return;
    }
    if (reaction.hand) hub_.put_hand(number, *reaction.hand);
    if (reaction.wrench) hub_.put_wrench(number, *reaction.wrench);
    answer(std::move(reaction.frames));
  }

  Command command_of(const live::Order& order) const {
    Command command{.page = number, .id = order.id, .argument = order.name, .value = order.value};
    if (order.kind == live::Order::Kind::kSet) {
      command.name = CommandName::kSet;
    } else if (order.name == "mark") {
      command.name = CommandName::kMark;
    } else {
      command.name = CommandName::kMode;
      if (order.name == "stop") command.argument = "hold";
    }
    return command;
  }

  void write() {
    if (is_writing_) return;  // one at a time; its completion calls again
    if (!answers_.empty()) {
      current_ = std::move(answers_.front());
      answers_.pop_front();
      answer_bytes_ -= own_bytes(current_);
    } else if (!data_.empty()) {
      current_ = std::move(data_.front());
      data_.pop_front();
      data_bytes_ -= current_.size();
      ++hub_.sent;
    } else if (lost_ > 0) {
      current_ = live::Session::status(
          live::Session::kWarning,
          std::to_string(std::exchange(lost_, 0)) + " messages were dropped: too slow for them");
    } else {
      return;
    }
    is_writing_ = true;
    socket_.text(current_.is_text);
    const std::string_view rest = current_.payload ? *current_.payload : std::string_view();
    const std::array<asio::const_buffer, 2> parts = {asio::buffer(current_.head),
                                                     asio::buffer(rest.data(), rest.size())};
    socket_.async_write(parts, [self = shared_from_this()](error_code error, std::size_t) {
      self->is_writing_ = false;
      if (!error) self->write();
    });
  }

  Hub& hub_;
  websocket::stream<beast::tcp_stream> socket_;
  asio::steady_timer pause_;
  std::shared_ptr<int> connection_, place_;
  beast::flat_buffer buffer_;
  live::Session session_;
  MessageRate rate_{kFrameRate_Hz};
  MessageRate order_rate_{kOrderRate_Hz};
  MessageRate byte_rate_{kBytesPerSecond};
  std::deque<live::Frame> answers_, data_;  // waiting
  std::size_t answer_bytes_ = 0, data_bytes_ = 0;
  std::uint64_t lost_ = 0;  // messages dropped since the last status
  live::Frame current_;     // being sent
  bool is_writing_ = false;
};

}  // namespace hg::viewer_server

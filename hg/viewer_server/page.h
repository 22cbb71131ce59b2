/// One open page: sends all events and the newest frame to it, reads its hand targets and commands.
#pragma once

#include <boost/asio/buffer.hpp>
#include <deque>
#include <memory>
#include <string_view>
#include <utility>

#include "hg/viewer_server/hub.h"
#include "hg/viewer_server/message_rate.h"
#include "hg/viewer_server/messages.h"
#include "hg/viewer_server/pings.h"

namespace hg::viewer_server {

/// Connection of one page; destroyed when it closes.
class Page : public std::enable_shared_from_this<Page> {
 public:
  Page(Hub& hub, beast::tcp_stream&& stream, std::shared_ptr<int> connection)
      : hub_(hub), socket_(std::move(stream)), connection_(std::move(connection)) {}

  void start(const Request& request) {
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout{kRequestTimeout, kRequestTimeout, true});
    socket_.read_message_max(kLargestMessage);
    socket_.text(true);
    socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, kProtocol);
    }));
    pings.listen(socket_, hub_);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->hub_.join(self);
      self->read();
    });
  }

  /// Queues a frame; replaces one that is still waiting.
  void show(Text frame) {
    if (frame_) ++hub_.dropped;
    frame_ = std::move(frame);
    write();
    pings.send(socket_, shared_from_this());
  }

  void notify(Text event) { queue(std::move(event), events_); }

  /// Answers go before events, which may be many.
  void answer(double id, std::string_view refusal) {
    queue(to_text(encode_answer(id, refusal)), answers_);
  }

  std::uint64_t number = 0;
  Pings pings;

 private:
  void queue(Text text, std::deque<Text>& waiting) {
    if (waiting.size() == kMaxEvents) {
      waiting.pop_front();
      ++hub_.dropped;
    }
    waiting.push_back(std::move(text));
    write();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) {
        if (error == websocket::error::message_too_big) ++self->hub_.refused;
        self->hub_.leave(self);
        return;
      }
      self->listen();
      self->read();
    });
  }

  void listen() {
    const auto bytes = buffer_.cdata();
    const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
    PageMessage message;
    const DecodeStatus status =
        socket_.got_text() ? decode(text, message) : DecodeStatus::kMalformed;
    if (status == DecodeStatus::kCommand) {
      listen(message.command);  // never limited by earlier messages: it may be a stop
    } else if (!rate_.admit(now_s())) {
      ++hub_.refused;  // without an answer, which would only amplify a flood
    } else if (status == DecodeStatus::kHand) {
      hub_.put_hand(number, message.hand);
    } else if (status == DecodeStatus::kHold) {
      hold(message.hold);
    } else {
      refuse(-1.0, refusal_text(status));
    }
    buffer_.clear();
  }

  void listen(Command& command) {
    command.page = number;
    const auto refusal = hub_.take(command, command_rate_);
    if (!refusal) return;
    refusal->empty() ? answer(command.id, {}) : refuse(command.id, *refusal);
  }

  void hold(double sequence) {
    if (sequence <= last_hold_) {
      ++hub_.refused;
    } else if (last_hold_ = sequence; hub_.desk != nullptr) {
      hub_.desk->hear(number, now_ns());
    }
  }

  void refuse(double id, std::string_view reason) {
    ++hub_.refused;
    answer(id, reason);
  }

  void write() {
    if (current_) return;  // one at a time; its completion calls again
    if (!answers_.empty()) {
      current_ = std::move(answers_.front());
      answers_.pop_front();
    } else if (!events_.empty()) {
      current_ = std::move(events_.front());
      events_.pop_front();
    } else if (frame_) {
      current_ = std::move(frame_);
      ++hub_.sent;
    } else {
      return;
    }
    socket_.async_write(asio::buffer(*current_),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          self->current_.reset();
                          if (!error) self->write();
                        });
  }

  Hub& hub_;
  websocket::stream<beast::tcp_stream> socket_;
  std::shared_ptr<int> connection_;
  beast::flat_buffer buffer_;
  MessageRate rate_{kMessageRate_Hz};
  MessageRate command_rate_{kCommandRate_Hz};
  double last_hold_ = -1.0;            // sequence number
  std::deque<Text> answers_, events_;  // waiting
  Text frame_;                         // waiting
  Text current_;                       // being sent
};

}  // namespace hg::viewer_server

#include "apps/ros2/live_connection.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstring>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace hg::bridges {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using nlohmann::json;

constexpr std::size_t kMostWaiting = 256;       // messages to the run
constexpr int kErrorLevel = 2;                  // of a status
constexpr std::size_t kMostSaid = 200;          // of an HTTP answer
constexpr std::size_t kMostBytes = 64u << 20u;  // of one message from the run
constexpr std::chrono::seconds kPatience(5);    // for a run that says nothing at all
constexpr char kMessage = 1, kTime = 2, kResponse = 3, kAsset = 4;  // from the server
constexpr char kOwnMessage = 1, kOwnRequest = 2;                    // from a client

// Takes a number off the front; 0 where the bytes end too early.
template <typename Number>
Number take(Bytes& bytes) {
  Number number = 0;
  const std::size_t size = std::min(sizeof number, bytes.size());
  if (size == sizeof number) std::memcpy(&number, bytes.data(), size);
  bytes.remove_prefix(size);
  return number;
}

Bytes take(Bytes& bytes, std::size_t size) {
  const Bytes front = bytes.substr(0, size);
  bytes.remove_prefix(front.size());
  return front;
}

void append(std::string& bytes, std::uint32_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

class Connection final : public LiveConnection, public std::enable_shared_from_this<Connection> {
 public:
  Connection(asio::io_context& context, LiveListener& listener)
      : listener_(&listener), resolver_(context), socket_(context) {}

  void connect(const LiveAddress& address);
  void abandon() override;
  std::uint32_t offer(std::string_view topic, std::string_view type) override;
  void withdraw(std::uint32_t topic) override;
  void publish(std::uint32_t topic, Bytes message) override;
  void call(std::uint32_t service, std::uint32_t call, Bytes request) override;
  void call_at_once(std::uint32_t service, std::uint32_t call, Bytes request) override;
  void send(const json& message) override;
  std::uint64_t dropped() const override { return dropped_; }

 private:
  struct Waiting {
    std::string bytes;
    bool is_text;
    std::uint32_t call = 0;  // number; 0: no call
    bool is_urgent = false;
  };
  void open();
  std::string refusal(beast::error_code error) const;
  void read();
  void take_text(std::string_view text);
  void take_channels(const json& channels);
  void take_services(const json& services);
  void take_bytes(Bytes bytes);
  static std::string call_bytes(std::uint32_t service, std::uint32_t call, Bytes request);
  void push(Waiting waiting);
  void write();
  void end(const std::string& why);

  LiveListener* listener_;  // null: abandoned, or closed
  asio::ip::tcp::resolver resolver_;
  websocket::stream<beast::tcp_stream> socket_;
  websocket::response_type response_;  // to the handshake
  beast::flat_buffer buffer_;
  LiveAddress address_;
  std::deque<Waiting> waiting_;
  Waiting writing_;
  std::map<std::uint32_t, LiveChannel> channels_;  // by id, also the id of our subscription
  std::map<std::uint32_t, LiveService> services_;
  std::uint32_t offers_ = 0;
  std::uint64_t dropped_ = 0;
  bool is_writing_ = false;
};

void Connection::connect(const LiveAddress& address) {
  address_ = address;
  resolver_.async_resolve(address.host, address.port,
                          [self = shared_from_this()](auto error, const auto& endpoints) {
                            if (error) return self->end(error.message());
                            beast::get_lowest_layer(self->socket_).expires_after(kPatience);
                            beast::get_lowest_layer(self->socket_)
                                .async_connect(endpoints, [self](auto refused, const auto&) {
                                  if (refused) return self->end(refused.message());
                                  self->open();
                                });
                          });
}

void Connection::open() {
  beast::get_lowest_layer(socket_).expires_never();
  beast::error_code ignored;
  beast::get_lowest_layer(socket_).socket().set_option(asio::ip::tcp::no_delay(true), ignored);
  socket_.set_option(
      websocket::stream_base::timeout{kPatience, kPatience, /*keep_alive_pings=*/true});
  socket_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
    request.set(beast::http::field::sec_websocket_protocol, "foxglove.sdk.v1");
  }));
  socket_.read_message_max(kMostBytes);
  const bool is_v6 = address_.host.find(':') != std::string::npos;
  const std::string host = is_v6 ? "[" + address_.host + "]" : address_.host;
  socket_.async_handshake(response_, host + ":" + address_.port, address_.target,
                          [self = shared_from_this()](auto error) {
                            if (error) return self->end(self->refusal(error));
                            self->read();
                          });
}

std::string Connection::refusal(beast::error_code error) const {
  if (error != websocket::error::upgrade_declined) return error.message();
  const int status = response_.result_int();
  if (response_.result() == beast::http::status::forbidden) {
    return "the token is that of another run, or wrong (HTTP 403)";
  }
  const std::string reason(response_.reason().data(), response_.reason().size());
  std::string said = response_.body().substr(0, kMostSaid);
  std::replace(said.begin(), said.end(), '\n', ' ');
  return "expected a run there, got HTTP " + std::to_string(status) + " " + reason +
         (said.empty() ? "" : ": ") + said;
}

void Connection::abandon() {
  listener_ = nullptr;
  beast::get_lowest_layer(socket_).close();
}

void Connection::end(const std::string& why) {
  LiveListener* listener = std::exchange(listener_, nullptr);
  beast::get_lowest_layer(socket_).close();
  if (listener != nullptr) listener->closed(why);
}

void Connection::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](auto error, std::size_t) {
    if (self->listener_ == nullptr) return;
    if (error == websocket::error::closed || error == asio::error::eof) {
      return self->end("the run has ended");
    }
    if (error == beast::error::timeout) return self->end("the run is silent");
    if (error) return self->end(error.message());
    const auto data = self->buffer_.data();
    const std::string_view text(static_cast<const char*>(data.data()), data.size());
    try {
      if (self->socket_.got_text()) {
        self->take_text(text);
      } else {
        self->take_bytes(text);
      }
    } catch (const json::exception& broken) {
      return self->end(std::string("a message that cannot be read: ") + broken.what());
    }
    self->buffer_.consume(self->buffer_.size());
    if (self->listener_ != nullptr) self->read();
  });
}

void Connection::take_text(std::string_view text) {
  const json message = json::parse(text);
  const std::string op = message.at("op");
  if (op == "serverInfo") {
    listener_->opened(message.at("name"));
  } else if (op == "advertise") {
    take_channels(message.at("channels"));
  } else if (op == "unadvertise") {
    for (const auto& id : message.at("channelIds")) channels_.erase(id.get<std::uint32_t>());
  } else if (op == "advertiseServices") {
    take_services(message.at("services"));
  } else if (op == "unadvertiseServices") {
    for (const auto& id : message.at("serviceIds")) {
      const auto found = services_.find(id.get<std::uint32_t>());
      if (found == services_.end()) continue;
      listener_->withdrawn(found->second);
      services_.erase(found);
    }
  } else if (op == "parameterValues") {
    listener_->parameters(message.at("parameters"), message.value("id", ""));
  } else if (op == "serviceCallFailure") {
    listener_->failed(message.at("callId"), message.value("message", ""));
  } else if (op == "status") {
    listener_->status(message.value("message", ""), message.value("level", 0) == kErrorLevel);
  }
}

void Connection::take_channels(const json& channels) {
  json subscriptions = json::array();
  for (const json& one : channels) {
    const LiveChannel channel = {one.at("id"), one.at("topic"), one.at("schemaName")};
    if (one.at("encoding") != "cdr" || !listener_->offered(channel)) continue;
    channels_[channel.id] = channel;
    subscriptions.push_back({{"id", channel.id}, {"channelId", channel.id}});
  }
  if (!subscriptions.empty()) send({{"op", "subscribe"}, {"subscriptions", subscriptions}});
}

void Connection::take_services(const json& services) {
  for (const json& one : services) {
    const LiveService service = {one.at("id"), one.at("name"), one.at("type")};
    services_[service.id] = service;
    listener_->offered(service);
  }
}

void Connection::take_bytes(Bytes bytes) {
  switch (take<char>(bytes)) {
    case kMessage: {
      const auto found = channels_.find(take<std::uint32_t>(bytes));
      take<std::uint64_t>(bytes);  // the time of the log; messages have stamps of their own
      if (found != channels_.end()) listener_->received(found->second, bytes);
      break;
    }
    case kTime:
      listener_->clock(take<std::uint64_t>(bytes));
      break;
    case kResponse: {
      take<std::uint32_t>(bytes);  // service
      const auto call = take<std::uint32_t>(bytes);
      take(bytes, take<std::uint32_t>(bytes));  // encoding
      listener_->answered(call, bytes);
      break;
    }
    case kAsset: {
      const auto request = take<std::uint32_t>(bytes);
      const bool is_ok = take<std::uint8_t>(bytes) == 0;
      const std::string error(take(bytes, take<std::uint32_t>(bytes)));
      listener_->fetched(request, {is_ok, error, bytes});
      break;
    }
    default:
      break;
  }
}

std::uint32_t Connection::offer(std::string_view topic, std::string_view type) {
  const std::uint32_t id = ++offers_;
  send({{"op", "advertise"},
        {"channels", {{{"id", id}, {"topic", topic}, {"encoding", "cdr"}, {"schemaName", type}}}}});
  return id;
}

void Connection::withdraw(std::uint32_t topic) {
  send({{"op", "unadvertise"}, {"channelIds", {topic}}});
}

void Connection::publish(std::uint32_t topic, Bytes message) {
  if (waiting_.size() >= kMostWaiting) {
    ++dropped_;
    return;
  }
  std::string bytes(1, kOwnMessage);
  append(bytes, topic);
  bytes += message;
  push({std::move(bytes), false});
}

void Connection::call(std::uint32_t service, std::uint32_t call, Bytes request) {
  push({call_bytes(service, call, request), false, call});
}

void Connection::call_at_once(std::uint32_t service, std::uint32_t call, Bytes request) {
  std::vector<std::uint32_t> overtaken;
  const auto is_overtaken = [](const Waiting& one) { return one.call != 0 && !one.is_urgent; };
  for (const Waiting& one : waiting_) {
    if (is_overtaken(one)) overtaken.push_back(one.call);
  }
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), is_overtaken), waiting_.end());
  waiting_.push_front({call_bytes(service, call, request), false, call, true});
  for (const std::uint32_t each : overtaken) listener_->failed(each, "a stop came after it");
  if (!is_writing_) write();
}

std::string Connection::call_bytes(std::uint32_t service, std::uint32_t call, Bytes request) {
  constexpr std::string_view kEncoding = "cdr";
  std::string bytes(1, kOwnRequest);
  append(bytes, service);
  append(bytes, call);
  append(bytes, static_cast<std::uint32_t>(kEncoding.size()));
  bytes += kEncoding;
  bytes += request;
  return bytes;
}

// names of others may hold any bytes: what is not UTF-8 is replaced, and then found nowhere
void Connection::send(const json& message) {
  push({message.dump(-1, ' ', false, json::error_handler_t::replace), true});
}

void Connection::push(Waiting waiting) {
  waiting_.push_back(std::move(waiting));
  if (!is_writing_) write();
}

void Connection::write() {
  if (waiting_.empty() || listener_ == nullptr) return;
  is_writing_ = true;
  writing_ = std::move(waiting_.front());
  waiting_.pop_front();
  socket_.text(writing_.is_text);
  socket_.async_write(asio::buffer(writing_.bytes),
                      [self = shared_from_this()](auto error, std::size_t) {
                        self->is_writing_ = false;
                        if (!error) self->write();  // else: reading ends, too, and says why
                      });
}

}  // namespace

std::shared_ptr<LiveConnection> connect_live(asio::io_context& context, const LiveAddress& address,
                                             LiveListener& listener) {
  const auto made = std::make_shared<Connection>(context, listener);
  made->connect(address);
  return made;
}

}  // namespace hg::bridges

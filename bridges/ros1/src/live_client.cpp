#include "live_client.h"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstring>
#include <deque>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace hapticgiant {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using nlohmann::json;
using tcp = asio::ip::tcp;

constexpr auto kPatience = std::chrono::seconds(5);  // for an answer, and of a silent connection
constexpr auto kPause = std::chrono::milliseconds(500);    // between two attempts
constexpr std::size_t kLargestMessage = 64 * 1024 * 1024;  // bytes; an asset
constexpr std::size_t kMostWaiting = 64;                   // messages on their way out
constexpr const char *kAll = "all", *kSet = "set";         // requests of parameters
constexpr const char* kSubprotocol = "foxglove.sdk.v1";

enum FromServer : std::uint8_t { kMessage = 1, kTime = 2, kServiceResponse = 3, kAsset = 4 };
enum ToServer : std::uint8_t { kPublish = 1, kServiceRequest = 2 };

template <typename T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);  // the protocol is little endian
}

// Takes a number off the front; 0 where the bytes end too early.
template <typename T>
T take(Bytes& bytes) {
  T value = 0;
  const std::size_t size = std::min(sizeof value, bytes.size());
  if (size == sizeof value) std::memcpy(&value, bytes.data(), size);
  bytes.remove_prefix(size);
  return value;
}

Bytes take(Bytes& bytes, std::size_t size) {
  const Bytes front = bytes.substr(0, size);
  bytes.remove_prefix(front.size());
  return front;
}

// An IPv6 address without its brackets.
std::string bare(std::string host) {
  if (!host.empty() && host.front() == '[') host = host.substr(1, host.size() - 2);
  return host;
}

}  // namespace

// One connection, from the first byte to its end.
class LiveClient::Session : public std::enable_shared_from_this<Session> {
 public:
  explicit Session(LiveClient& client) : client_(&client), socket_(client.context_) {}

  void start() {
    const Link& link = client_->link_;
    tcp::resolver resolver(client_->context_);
    error_code error;
    const auto endpoints = resolver.resolve(bare(link.host), link.port, error);
    if (error) return end("cannot find " + link.host + ": " + error.message());
    stream().expires_after(kPatience);
    stream().async_connect(endpoints, [self = shared_from_this()](error_code error, const auto&) {
      if (error) return self->end("no run answers at its link: " + error.message());
      self->shake_hands();
    });
  }

  // Reports the end of the connection, once.
  void end(const std::string& reason) {
    LiveClient* client = std::exchange(client_, nullptr);
    if (client == nullptr) return;
    error_code ignored;
    stream().socket().close(ignored);
    for (auto* requests : {&calls_, &fetches_}) {
      for (auto& [id, on_answer] : *requests) on_answer({false, "the connection was lost", {}});
    }
    client->retry(reason);
  }

  // Ends without a report.
  void drop() {
    client_ = nullptr;
    error_code ignored;
    stream().socket().close(ignored);
  }

  void publish(const std::string& topic, Bytes message) {
    if (out_.size() >= kMostWaiting) return;
    const auto& all = client_->publications_;
    const auto one = std::find_if(all.begin(), all.end(),
                                  [&](const Publication& p) { return p.topic == topic; });
    if (one == all.end()) return;
    std::string bytes;
    put<std::uint8_t>(bytes, kPublish);
    put<std::uint32_t>(bytes, static_cast<std::uint32_t>(one - all.begin()) + 1);
    bytes.append(message);
    send(std::move(bytes), false);
  }

  void call(const std::string& service, Bytes request, OnAnswer on_answer) {
    const bool is_stop = service == kStop;
    const auto found = services_.find(service);
    if (found == services_.end()) {
      return on_answer({false, "the program has no service " + service, {}});
    }
    std::string bytes;
    put<std::uint8_t>(bytes, kServiceRequest);
    put<std::uint32_t>(bytes, found->second);
    put<std::uint32_t>(bytes, ++last_id_);
    put<std::uint32_t>(bytes, 3);
    bytes += "cdr";
    bytes.append(request);
    calls_[last_id_] = std::move(on_answer);
    if (is_stop) overtake();
    send(std::move(bytes), false, last_id_, is_stop);
  }

  void fetch(const std::string& uri, OnAnswer on_answer) {
    fetches_[++last_id_] = std::move(on_answer);
    send_json({{"op", "fetchAsset"}, {"uri", uri}, {"requestId", last_id_}});
  }

  // names of others may hold any bytes: what is not UTF-8 is replaced, and then found nowhere
  void send_json(const json& message) {
    send(message.dump(-1, ' ', false, json::error_handler_t::replace), true);
  }

 private:
  struct Out {
    std::string bytes;
    bool is_text = false;
    std::uint32_t call = 0;  // number; 0: no call
    bool is_stop = false;
  };

  // A call that waits when a stop comes is not made any more: it could undo the stop.
  void overtake() {
    std::vector<std::uint32_t> overtaken;
    for (auto one = out_.begin(); one != out_.end();) {
      const bool is_kept = one->call == 0 || one->is_stop;
      if (!is_kept) overtaken.push_back(one->call);
      one = is_kept ? std::next(one) : out_.erase(one);
    }
    for (const std::uint32_t id : overtaken)
      answer(calls_, id, {false, "a stop came after it", {}});
  }

  beast::tcp_stream& stream() { return socket_.next_layer(); }

  void shake_hands() {
    stream().expires_never();
    socket_.set_option(
        websocket::stream_base::timeout{kPatience, kPatience, /*keep_alive_pings=*/true});
    socket_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(http::field::sec_websocket_protocol, kSubprotocol);
    }));
    socket_.read_message_max(kLargestMessage);
    const Link& link = client_->link_;
    socket_.async_handshake(response_, link.host + ":" + link.port, "/live?token=" + link.token,
                            [self = shared_from_this()](error_code error) {
                              if (error) return self->end(self->refusal(error));
                              self->opened();
                            });
  }

  std::string refusal(error_code error) const {
    if (error != websocket::error::upgrade_declined) return error.message();
    std::string body = response_.body();
    while (!body.empty() && body.back() == '\n') body.pop_back();
    return "the program refuses: " + std::to_string(response_.result_int()) + " " + body;
  }

  void opened() {
    json channels = json::array();
    for (const Publication& one : client_->publications_) {
      channels.push_back({{"id", channels.size() + 1},
                          {"topic", one.topic},
                          {"encoding", "cdr"},
                          {"schemaName", one.type}});
    }
    client_->events_.opened();
    if (client_ == nullptr) return;
    if (!channels.empty()) send_json({{"op", "advertise"}, {"channels", channels}});
    send_json({{"op", "getParameters"}, {"parameterNames", json::array()}, {"id", kAll}});
    read();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error == websocket::error::closed) return self->end("the program has ended");
      if (error) return self->end(error.message());
      if (self->client_ == nullptr) return;
      const auto data = self->buffer_.cdata();
      const Bytes bytes(static_cast<const char*>(data.data()), data.size());
      if (self->socket_.got_binary()) {
        self->take_binary(bytes);
      } else {
        self->take_json(json::parse(bytes, nullptr, false));
      }
      self->buffer_.consume(bytes.size());
      if (self->client_ != nullptr) self->read();
    });
  }

  void take_binary(Bytes bytes) {
    switch (take<std::uint8_t>(bytes)) {
      case kMessage: {
        const auto topic = subscriptions_.find(take<std::uint32_t>(bytes));
        take<std::uint64_t>(bytes);  // the time of the log; messages have stamps of their own
        if (topic != subscriptions_.end()) client_->events_.message(topic->second, bytes);
        break;
      }
      case kTime:
        client_->events_.time(take<std::uint64_t>(bytes));
        break;
      case kServiceResponse: {
        take<std::uint32_t>(bytes);  // service
        const auto id = take<std::uint32_t>(bytes);
        take(bytes, take<std::uint32_t>(bytes));  // encoding
        answer(calls_, id, {true, {}, std::string(bytes)});
        break;
      }
      case kAsset: {
        const auto id = take<std::uint32_t>(bytes);
        const bool is_ok = take<std::uint8_t>(bytes) == 0;
        const std::string error(take(bytes, take<std::uint32_t>(bytes)));
        answer(fetches_, id, {is_ok, error, std::string(bytes)});
        break;
      }
    }
  }

  void take_json(const json& message) try {
    const std::string op = message.at("op");
    if (op == "advertise") {
      subscribe(message.at("channels"));
    } else if (op == "unadvertise") {
      for (const std::uint32_t channel : message.at("channelIds")) subscriptions_.erase(channel);
    } else if (op == "advertiseServices") {
      for (const json& service : message.at("services")) {
        services_[service.at("name")] = service.at("id");
      }
    } else if (op == "parameterValues") {
      const json& parameters = message.at("parameters");
      const std::string id = message.value("id", "");
      client_->events_.parameters(parameters, id == kSet);
      if (client_ != nullptr && id == kAll) watch(parameters);
    } else if (op == "serviceCallFailure") {
      answer(calls_, message.at("callId"), {false, message.at("message"), {}});
    } else if (op == "status") {
      client_->events_.status(message.at("message"), message.at("level") == 2);
    }
  } catch (const json::exception& error) {
    end(std::string("not the protocol: ") + error.what());
  }

  // The number of a channel is that of its subscription, too.
  void subscribe(const json& channels) {
    json wanted = json::array();
    for (const json& channel : channels) {
      const std::string topic = channel.at("topic");
      const auto& topics = client_->topics_;
      if (channel.at("encoding") != "cdr") continue;
      if (std::find(topics.begin(), topics.end(), topic) == topics.end()) continue;
      const std::uint32_t id = channel.at("id");
      subscriptions_[id] = topic;
      wanted.push_back({{"id", id}, {"channelId", id}});
    }
    if (!wanted.empty()) send_json({{"op", "subscribe"}, {"subscriptions", wanted}});
  }

  void watch(const json& parameters) {
    json names = json::array();
    for (const json& parameter : parameters) names.push_back(parameter.at("name"));
    send_json({{"op", "subscribeParameterUpdates"}, {"parameterNames", names}});
  }

  static void answer(std::map<std::uint32_t, OnAnswer>& requests, std::uint32_t id,
                     const Answer& answer) {
    if (auto request = requests.extract(id)) request.mapped()(answer);
  }

  // A stop goes out before all that waits.
  void send(std::string bytes, bool is_text, std::uint32_t call = 0, bool is_stop = false) {
    Out out{std::move(bytes), is_text, call, is_stop};
    if (is_stop) {
      out_.push_front(std::move(out));
    } else {
      out_.push_back(std::move(out));
    }
    if (!is_writing_) write();
  }

  void write() {
    is_writing_ = true;
    writing_ = std::move(out_.front());
    out_.pop_front();
    socket_.text(writing_.is_text);
    socket_.async_write(asio::buffer(writing_.bytes),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          if (error) return self->end(error.message());
                          self->is_writing_ = false;
                          if (!self->out_.empty()) self->write();
                        });
  }

  LiveClient* client_;  // null once it has ended
  websocket::stream<beast::tcp_stream> socket_;
  websocket::response_type response_;
  beast::flat_buffer buffer_;
  std::deque<Out> out_;  // waits
  Out writing_;
  bool is_writing_ = false;
  std::map<std::uint32_t, std::string> subscriptions_;
  std::map<std::string, std::uint32_t> services_;
  std::map<std::uint32_t, OnAnswer> calls_, fetches_;
  std::uint32_t last_id_ = 0;
};

LiveClient::LiveClient(asio::io_context& context, FindLink find_link,
                       std::vector<std::string> topics, std::vector<Publication> publications,
                       LiveEvents events)
    : context_(context),
      find_link_(std::move(find_link)),
      topics_(std::move(topics)),
      publications_(std::move(publications)),
      events_(std::move(events)),
      timer_(context) {
  timer_.expires_after(std::chrono::seconds(0));
  timer_.async_wait([this](error_code error) {
    if (!error) connect();
  });
}

LiveClient::~LiveClient() {
  if (session_) session_->drop();
}

void LiveClient::connect() {
  try {
    link_ = find_link_();
  } catch (const std::exception& error) {
    return retry(error.what());
  }
  session_ = std::make_shared<Session>(*this);
  session_->start();
}

void LiveClient::retry(const std::string& reason) {
  session_.reset();
  timer_.expires_after(kPause);
  timer_.async_wait([this](error_code error) {
    if (!error) connect();
  });
  events_.closed(reason);
}

void LiveClient::publish(const std::string& topic, Bytes message) {
  if (session_) session_->publish(topic, message);
}

void LiveClient::call(const std::string& service, Bytes request, OnAnswer on_answer) {
  if (!session_) return on_answer({false, "not connected to the program", {}});
  session_->call(service, request, std::move(on_answer));
}

void LiveClient::fetch(const std::string& uri, OnAnswer on_answer) {
  if (!session_) return on_answer({false, "not connected to the program", {}});
  session_->fetch(uri, std::move(on_answer));
}

void LiveClient::set_parameter(const std::string& name, const json& value) {
  if (!session_) return;
  session_->send_json({{"op", "setParameters"},
                       {"parameters", json::array({{{"name", name}, {"value", value}}})},
                       {"id", kSet}});
}

std::string LiveClient::get(const std::string& path) const {
  try {
    asio::io_context context;
    beast::tcp_stream stream(context);
    http::request<http::empty_body> request(http::verb::get, path, 11);
    request.set(http::field::host, link_.host + ":" + link_.port);
    request.set(http::field::authorization, "Bearer " + link_.token);
    request.set(http::field::connection, "close");
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(kLargestMessage);
    error_code result = asio::error::would_block;
    const auto endpoints = tcp::resolver(context).resolve(bare(link_.host), link_.port);
    stream.expires_after(kPatience);
    const auto finish = [&](error_code error, std::size_t) { result = error; };
    stream.async_connect(endpoints, [&](error_code error, const auto&) {
      if (error) return finish(error, 0);
      http::async_write(stream, request, [&](error_code error, std::size_t size) {
        if (error) return finish(error, size);
        http::async_read(stream, buffer, parser, finish);
      });
    });
    context.run();
    if (result) throw std::runtime_error(result.message());
    if (parser.get().result() != http::status::ok) {
      throw std::runtime_error(std::to_string(parser.get().result_int()) + " " +
                               parser.get().body());
    }
    return parser.release().body();
  } catch (const std::exception& error) {
    throw std::runtime_error(path + " of the program: " + error.what());
  }
}

}  // namespace hapticgiant

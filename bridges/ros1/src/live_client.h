/// Client of the live interface of a running program: the Foxglove WebSocket protocol, version 1.
///
/// Source: https://github.com/foxglove/ws-protocol (specification). Messages are CDR bytes.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "link.h"

namespace hapticgiant {

using Bytes = std::string_view;

/// The service whose calls overtake all others: those that still wait fail.
inline constexpr const char* kStop = "/hapticgiant/stop";

/// Answer of a service or of fetch().
struct Answer {
  bool is_ok = false;
  std::string error;  ///< why it failed
  std::string bytes;  ///< CDR of a response, or the content of an asset
};

using OnAnswer = std::function<void(const Answer&)>;

/// What a client reports, on the thread of its io_context.
struct LiveEvents {
  std::function<void()> opened;  ///< connected
  std::function<void(const std::string& reason)> closed;
  std::function<void(const std::string& topic, Bytes message)> message;
  std::function<void(std::uint64_t time_ns)> time;  ///< the run's clock
  /// `is_answer`: to set_parameter()
  std::function<void(const nlohmann::json& parameters, bool is_answer)> parameters;
  std::function<void(const std::string& text, bool is_error)> status;
};

/// Message type that the client publishes on a topic.
struct Publication {
  std::string topic, type;
};

/// Where the program is; asked before each attempt to connect. May throw std::runtime_error.
using FindLink = std::function<Link()>;

/// Connection that is opened again whenever it is lost. All functions are for the thread of the
/// io_context. A program that is too slow to take messages loses them; requests without a
/// connection fail at once.
class LiveClient {
 public:
  LiveClient(boost::asio::io_context& context, FindLink find_link, std::vector<std::string> topics,
             std::vector<Publication> publications, LiveEvents events);
  ~LiveClient();

  void publish(const std::string& topic, Bytes message);
  void call(const std::string& service, Bytes request, OnAnswer on_answer);
  void fetch(const std::string& uri, OnAnswer on_answer);
  void set_parameter(const std::string& name, const nlohmann::json& value);

  /// Content of `path` of the program's page, for example "/scene.json". Waits up to 5 s; throws
  /// std::runtime_error when it cannot be had.
  std::string get(const std::string& path) const;

 private:
  class Session;

  void connect();
  void retry(const std::string& reason);

  boost::asio::io_context& context_;
  const FindLink find_link_;
  const std::vector<std::string> topics_;
  const std::vector<Publication> publications_;
  const LiveEvents events_;
  Link link_;
  boost::asio::steady_timer timer_;
  std::shared_ptr<Session> session_;
};

}  // namespace hapticgiant

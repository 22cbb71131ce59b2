/// Client of the live interface of a running program: the Foxglove WebSocket protocol, version 1.
///
/// Source: https://github.com/foxglove/ws-protocol, docs/spec.md. Messages are CDR bytes.
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

namespace hapticgiant {

using Bytes = std::string_view;

/// Address of a program and its secret, from the link that it prints.
struct Link {
  std::string host, port, token;
};

/// Reads "http://HOST:PORT/#token=TOKEN", or a file with such a link. Throws std::runtime_error
/// that says what was expected.
Link read_link(const std::string& link_or_file);

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
  std::function<void(const nlohmann::json& parameters)> parameters;
  std::function<void(const std::string& text, bool is_error)> status;
};

/// Message type that the client publishes on a topic.
struct Publication {
  std::string topic, type;
};

/// Connection that is opened again whenever it is lost. All functions are for the thread of the
/// io_context. A program that is too slow to take messages loses them; requests without a
/// connection fail at once.
class LiveClient {
 public:
  LiveClient(boost::asio::io_context& context, std::string link_or_file,
             std::vector<std::string> topics, std::vector<Publication> publications,
             LiveEvents events);
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
  const std::string link_or_file_;
  const std::vector<std::string> topics_;
  const std::vector<Publication> publications_;
  const LiveEvents events_;
  Link link_;
  boost::asio::steady_timer timer_;
  std::shared_ptr<Session> session_;
};

}  // namespace hapticgiant

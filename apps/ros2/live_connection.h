/// One connection with the live interface of a run: the Foxglove WebSocket protocol, version 1.
///
/// Source: https://github.com/foxglove/ws-protocol (specification). Messages are CDR bytes.
/// Everything happens in the thread of the io_context. C++17 without the rest of the program: the
/// bridge to ROS 1 has this file, too.
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace hg::bridges {

using Bytes = std::string_view;

/// Address of a live interface, ws://HOST:PORT/live?token=TOKEN; an IPv6 address without brackets.
struct LiveAddress {
  std::string host, port, target;
};

struct LiveChannel {
  std::uint32_t id = 0;
  std::string topic;  ///< "/joint_states"
  std::string type;   ///< "sensor_msgs/msg/JointState"
};

struct LiveService {
  std::uint32_t id = 0;
  std::string name, type;
};

struct LiveAsset {
  bool is_ok = false;
  std::string error;  ///< why there is none
  Bytes bytes;
};

/// What a connection reports.
class LiveListener {
 public:
  virtual ~LiveListener() = default;
  virtual void opened(const std::string& server) = 0;
  /// Whether to subscribe to this channel
  virtual bool offered(const LiveChannel& channel) = 0;
  virtual void offered(const LiveService& service) = 0;
  virtual void withdrawn(const LiveService& service) = 0;
  virtual void received(const LiveChannel& channel, Bytes message) = 0;
  virtual void clock(std::uint64_t /*time_ns*/) {}
  virtual void fetched(std::uint32_t /*request*/, const LiveAsset& /*asset*/) {}
  /// Values of parameters; `id` is that of the request that they answer, empty for news
  virtual void parameters(const nlohmann::json& values, const std::string& id) = 0;
  virtual void status(const std::string& text, bool is_error) = 0;
  virtual void answered(std::uint32_t call, Bytes message) = 0;
  virtual void failed(std::uint32_t call, const std::string& why) = 0;
  /// The connection has ended, or was never made. The last call.
  virtual void closed(const std::string& why) = 0;
};

class LiveConnection {
 public:
  virtual ~LiveConnection() = default;
  /// Ends it; the listener is not called any more.
  virtual void abandon() = 0;

  /// Topic that this client sends; returns its number, from 1 on.
  virtual std::uint32_t offer(std::string_view topic, std::string_view type) = 0;
  virtual void withdraw(std::uint32_t topic) = 0;
  /// Dropped where too many messages wait.
  virtual void publish(std::uint32_t topic, Bytes message) = 0;
  virtual void call(std::uint32_t service, std::uint32_t call, Bytes request) = 0;
  /// A call that overtakes all that waits. Calls that it overtakes are not made any more and are
  /// reported as failed, so that none of them undoes it.
  virtual void call_at_once(std::uint32_t service, std::uint32_t call, Bytes request) = 0;
  virtual void send(const nlohmann::json& message) = 0;
  /// Messages that were not sent, because the run did not take them in time
  virtual std::uint64_t dropped() const = 0;
};

/// Begins to connect. The listener is called from `context` only, after this function.
std::shared_ptr<LiveConnection> connect_live(boost::asio::io_context& context,
                                             const LiveAddress& address, LiveListener& listener);

}  // namespace hg::bridges

/// Client of the live interface of a run: the Foxglove WebSocket protocol.
///
/// Everything happens in the thread of the io_context.
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace hg::ros2 {

/// Address of a live interface, ws://HOST:PORT/live?token=TOKEN.
struct LiveAddress {
  std::string host, port, target;
};

/// Throws SetupError.
LiveAddress parse_live_address(const std::string& text);

struct LiveChannel {
  std::uint32_t id = 0;
  std::string topic;  ///< "/joint_states"
  std::string type;   ///< "sensor_msgs/msg/JointState"
};

struct LiveService {
  std::uint32_t id = 0;
  std::string name, type;
};

/// What a client learns.
class LiveListener {
 public:
  virtual ~LiveListener() = default;
  virtual void opened(const std::string& server) = 0;
  /// Whether to subscribe to this channel
  virtual bool offered(const LiveChannel& channel) = 0;
  virtual void offered(const LiveService& service) = 0;
  virtual void withdrawn(const LiveService& service) = 0;
  virtual void received(const LiveChannel& channel, std::span<const std::byte> message) = 0;
  /// Values of parameters; `id` is that of the request that they answer, empty for news
  virtual void parameters(const nlohmann::json& values, const std::string& id) = 0;
  virtual void on_status(const std::string& status) = 0;
  virtual void answered(std::uint32_t call, std::span<const std::byte> message) = 0;
  virtual void failed(std::uint32_t call, const std::string& why) = 0;
  /// The connection has ended, or was never made. The last call.
  virtual void closed(const std::string& why) = 0;
};

/// One connection.
class LiveClient {
 public:
  virtual ~LiveClient() = default;
  /// Ends it; the listener is not called any more.
  virtual void abandon() = 0;

  /// Topic that this client sends; returns its number, from 1 on.
  virtual std::uint32_t offer(std::string_view topic, std::string_view type) = 0;
  virtual void withdraw(std::uint32_t topic) = 0;
  virtual void publish(std::uint32_t topic, std::span<const std::byte> message) = 0;
  virtual void call(std::uint32_t service, std::uint32_t call,
                    std::span<const std::byte> request) = 0;
  /// A call that is never dropped and overtakes all that waits. Calls that it overtakes are not
  /// made any more: the listener learns that they failed, so that none of them undoes it.
  virtual void call_at_once(std::uint32_t service, std::uint32_t call,
                            std::span<const std::byte> request) = 0;
  virtual void send(const nlohmann::json& message) = 0;
  /// Messages that were not sent, because the run did not take them in time
  virtual std::uint64_t dropped() const = 0;
};

/// Begins to connect. The listener is called from `context` only.
std::shared_ptr<LiveClient> connect_live(boost::asio::io_context& context,
                                         const LiveAddress& address, LiveListener& listener);

}  // namespace hg::ros2

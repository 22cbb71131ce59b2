/// A node of ROS 2 on bare DDS, without ROS: topics and services under the names that ROS 2 gives
/// them, their messages as the CDR bytes that travel. ROS 2 calls the convention "rmw_fastrtps".
///
/// Calls come from one thread; the functions that take what arrives, from threads of the DDS.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hg::ros2 {

using Bytes = std::span<const std::byte>;

struct NodeOptions {
  std::string name = "hapticgiant";
  std::string space;      ///< namespace, for example "/lab/left"; empty: the root
  int domain = 0;         ///< 0..232
  bool is_local = false;  ///< other programs on this computer only
};

/// Whether this is a name of ROS 2, or several with / between them: letters, digits and single _,
/// no digit first, "lab/left". Source:
/// https://design.ros2.org/articles/topic_and_service_names.html
bool is_name(std::string_view text) noexcept;

/// How a topic is sent. All are reliable, so that reliable and best-effort subscribers match.
enum class Delivery {
  kStream,   ///< the last 10 messages wait for subscribers that are behind; older ones are dropped
  kLatched,  ///< the last message is given to each new subscriber, too (transient local)
};

class Publisher {
 public:
  virtual ~Publisher() = default;
  /// Sends one message: its CDR bytes with their header. False: the DDS has refused it.
  virtual bool publish(Bytes message) = 0;
  /// Number of subscribers that are connected now.
  virtual int subscribers() const = 0;
};

/// Reads what has arrived, at most 10 messages that are not read yet; older ones are dropped.
class Subscription {
 public:
  virtual ~Subscription() = default;
  /// Takes the oldest message; false: there is none.
  virtual bool take(std::vector<std::byte>& message) = 0;
  /// Number of publishers that are connected now.
  virtual int publishers() const = 0;
};

/// Request of a service, and where its answer goes.
struct Request {
  std::vector<std::byte> message;
  std::array<std::uint8_t, 16> client{};
  std::int64_t number = 0;
};

class Service {
 public:
  virtual ~Service() = default;
  virtual bool take(Request& request) = 0;
  /// False: the client's side of the answer is not connected yet (try again soon), or gone.
  virtual bool answer(const Request& request, Bytes message) = 0;
};

class Node {
 public:
  /// Throws SetupError.
  explicit Node(const NodeOptions& options);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// `topic` without namespace, "/joint_states"; `type` as in ROS, "sensor_msgs/msg/JointState".
  /// What this returns ends before the node. Throws SetupError.
  std::unique_ptr<Publisher> publish(std::string_view topic, std::string_view type, Delivery how);
  /// `arrived` is called by a thread of the DDS.
  std::unique_ptr<Subscription> subscribe(std::string_view topic, std::string_view type,
                                          std::function<void()> arrived);
  /// `name` "/hapticgiant/tare", `type` "std_srvs/srv/Trigger".
  std::unique_ptr<Service> serve(std::string_view name, std::string_view type,
                                 std::function<void()> arrived);

  /// Full name of a topic or service, with the namespace.
  std::string full_name(std::string_view topic) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hg::ros2

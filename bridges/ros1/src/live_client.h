/// Client of the live interface of a running program; it connects again whenever that ends.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/ros2/live_connection.h"
#include "link.h"

namespace hapticgiant {

using Bytes = hg::bridges::Bytes;

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
class LiveClient : private hg::bridges::LiveListener {
 public:
  LiveClient(boost::asio::io_context& context, FindLink find_link, std::vector<std::string> topics,
             std::vector<Publication> publications, LiveEvents events);
  ~LiveClient() override;

  void publish(const std::string& topic, Bytes message);
  void call(const std::string& service, Bytes request, OnAnswer on_answer);
  void fetch(const std::string& uri, OnAnswer on_answer);
  void set_parameter(const std::string& name, const nlohmann::json& value);

  /// Content of `path` of the program's page, for example "/scene.json". Waits up to 5 s; throws
  /// std::runtime_error when it cannot be had.
  std::string get(const std::string& path) const;

 private:
  using Requests = std::map<std::uint32_t, OnAnswer>;

  void opened(const std::string& server) override;
  bool offered(const hg::bridges::LiveChannel& channel) override;
  void offered(const hg::bridges::LiveService& service) override;
  void withdrawn(const hg::bridges::LiveService& service) override;
  void received(const hg::bridges::LiveChannel& channel, Bytes message) override;
  void clock(std::uint64_t time_ns) override;
  void fetched(std::uint32_t request, const hg::bridges::LiveAsset& asset) override;
  void parameters(const nlohmann::json& values, const std::string& id) override;
  void status(const std::string& text, bool is_error) override;
  void answered(std::uint32_t call, Bytes message) override;
  void failed(std::uint32_t call, const std::string& why) override;
  void closed(const std::string& why) override;

  void connect();
  void connect_after(std::chrono::milliseconds pause);
  static void answer(Requests& requests, std::uint32_t id, const Answer& answer);

  boost::asio::io_context& context_;
  const FindLink find_link_;
  const std::vector<std::string> topics_;
  const std::vector<Publication> publications_;
  const LiveEvents events_;
  Link link_;
  boost::asio::steady_timer timer_;
  std::shared_ptr<hg::bridges::LiveConnection> connection_;
  bool is_open_ = false;
  std::map<std::string, std::uint32_t> offers_;  ///< numbers of topics that this client sends
  std::map<std::string, std::uint32_t> services_;
  Requests calls_, fetches_;
  std::uint32_t last_id_ = 0;
};

}  // namespace hapticgiant

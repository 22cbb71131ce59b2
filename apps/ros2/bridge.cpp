#include "apps/ros2/bridge.h"

#include <fmt/format.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "apps/ros2/live_connection.h"
#include "apps/ros2/parameters.h"
#include "apps/ros2/type_hashes.h"
#include "hg/core/error.h"
#include "hg/core/visible.h"
#include "hg/live/link_file.h"
#include "hg/messages/cdr_reader.h"
#include "hg/messages/event.h"
#include "hg/messages/ros_messages.h"

namespace hg::ros2 {
namespace {

constexpr std::chrono::milliseconds kTick(20), kBetweenTries(500);
constexpr std::chrono::seconds kPatience(3);
constexpr std::size_t kMostCalls = 64;
constexpr std::string_view kStop = "/hapticgiant/stop";
constexpr std::string_view kTrigger = "std_srvs/srv/Trigger";
constexpr std::string_view kEvent = "hapticgiant_msgs/msg/Event";
constexpr std::string_view kText = "std_msgs/msg/String";

void say(const std::string& text) {
  std::fputs((visible(text) + "\n").c_str(), stdout);
  std::fflush(stdout);
}

std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Throws SetupError.
bridges::LiveAddress parse_live_address(const std::string& text) {
  const auto fail = [&] {
    return SetupError(fmt::format(
        "--live {}: expected the address that the run prints, ws://HOST:PORT/live?token=TOKEN",
        text));
  };
  constexpr std::string_view kScheme = "ws://";
  if (!text.starts_with(kScheme)) throw fail();
  const std::size_t slash = text.find('/', kScheme.size());
  const std::string authority = text.substr(kScheme.size(), slash - kScheme.size());
  const std::size_t colon = authority.rfind(':');
  if (slash == std::string::npos || colon == std::string::npos || colon == 0) throw fail();
  bridges::LiveAddress address = {authority.substr(0, colon), authority.substr(colon + 1),
                                  text.substr(slash)};
  if (address.host.starts_with('[') && address.host.ends_with(']')) {
    address.host = address.host.substr(1, address.host.size() - 2);
  }
  if (address.port.empty() || address.port.find_first_not_of("0123456789") != std::string::npos) {
    throw fail();
  }
  return address;
}

// connects node and run; one thread
class Bridge final : public bridges::LiveListener {
 public:
  explicit Bridge(const BridgeOptions& options);
  ~Bridge() override;
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  void run(const std::atomic<bool>& stop);

 private:
  using Clock = std::chrono::steady_clock;
  struct Out {
    std::string type;
    std::unique_ptr<Publisher> publisher;
    std::uint64_t sent = 0, refused = 0;
  };
  struct In {
    std::string topic, type;
    std::unique_ptr<Subscription> subscription;
    std::uint32_t offer = 0;  // number at the run; 0: not offered there
    std::uint64_t sent = 0;
  };
  struct Offered {
    std::unique_ptr<Service> service;
    std::uint32_t id = 0;  // at the run; 0: no run offers it
  };
  struct Call {
    std::string service;
    Request request;
    Clock::time_point since;
  };
  struct Unsent {
    std::string service;
    Request request;
    std::vector<std::byte> message;
    Clock::time_point since;
  };

  void opened(const std::string& server) override;
  bool offered(const bridges::LiveChannel& channel) override;
  void offered(const bridges::LiveService& service) override;
  void withdrawn(const bridges::LiveService& service) override;
  void received(const bridges::LiveChannel& channel, std::string_view message) override;
  void parameters(const nlohmann::json& values, const std::string& id) override;
  void status(const std::string& text, bool is_error) override;
  void answered(std::uint32_t call, std::string_view message) override;
  void failed(std::uint32_t call, const std::string& why) override;
  void closed(const std::string& why) override;

  void connect();
  void tick();
  void arrived();  // called by threads of the DDS
  void look_at_ros();
  void pass_on(In& in);
  void answer(const std::string& service, const Request& request, Bytes message);
  void refuse(const std::string& service, const Request& request, const std::string& why);
  void say_once(const std::string& text);
  void sum_up() const;

  BridgeOptions options_;
  boost::asio::io_context context_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_ =
      boost::asio::make_work_guard(context_);
  std::atomic<bool> is_due_ = false;  // outlives what calls arrived()
  Node node_;
  std::map<std::string, Out> out_;  // by topic
  std::vector<In> in_;
  std::map<std::string, Offered> services_;  // by name
  std::unique_ptr<Parameters> parameters_;
  std::shared_ptr<bridges::LiveConnection> client_;  // null: not connected, nor trying to
  bool is_open_ = false;
  Clock::time_point next_try_;
  std::map<std::uint32_t, Call> calls_;
  std::vector<Unsent> unsent_;
  std::uint32_t called_ = 0;
  std::uint64_t dropped_ = 0;
  std::string said_;
  messages::CdrWriter cdr_;
};

Bridge::Bridge(const BridgeOptions& options) : options_(options), node_(options.node) {
  if (!options.live.empty()) (void)parse_live_address(options.live);
  if (options.is_view) return;
  const auto arrived = [this] { this->arrived(); };
  for (const auto& [topic, type] :
       {std::pair{"/hand_target", "geometry_msgs/msg/PoseStamped"},
        std::pair{"/reference_wrench", "geometry_msgs/msg/WrenchStamped"}}) {
    in_.push_back({topic, type, node_.subscribe(topic, type, arrived)});
  }
  parameters_ = std::make_unique<Parameters>(node_, options.node.name, arrived);
}

Bridge::~Bridge() {
  if (client_) client_->abandon();
}

void Bridge::run(const std::atomic<bool>& stop) {
  say(fmt::format("ROS 2, domain {}: node {}{}{}", options_.node.domain,
                  node_.full_name("/" + options_.node.name),
                  options_.node.is_local ? ", this computer only" : "",
                  options_.is_view ? ", to look at only" : ""));
  while (!stop.load()) {
    context_.restart();
    context_.run_for(kTick);
    tick();
  }
  sum_up();
}

void Bridge::connect() {
  std::string address = options_.live;
  if (address.empty()) {
    const std::vector<std::string> runs = live::running_addresses();
    if (runs.empty()) return say_once("waiting for a run (hapticgiant run door)");
    if (runs.size() > 1) {
      say_once(fmt::format("{} runs are there, this is the newest; another one: --live ADDRESS",
                           runs.size()));
    }
    address = runs.front();
  }
  client_ = bridges::connect_live(context_, parse_live_address(address), *this);
}

void Bridge::opened(const std::string& server) {
  is_open_ = true;
  said_.clear();
  say(fmt::format("connected with a run of {}", server));
}

void Bridge::closed(const std::string& why) {
  dropped_ += client_->dropped();
  client_ = nullptr;
  next_try_ = Clock::now() + kBetweenTries;
  for (auto& [name, offered] : services_) offered.id = 0;
  for (In& in : in_) in.offer = 0;
  const std::string text = "no run is connected: " + why;
  for (const auto& [number, call] : std::exchange(calls_, {})) {
    refuse(call.service, call.request, text);
  }
  if (parameters_) parameters_->give_up(text, true);
  if (std::exchange(is_open_, false)) {
    say(why);
  } else {
    say_once("waiting for a run: " + why);
  }
}

bool Bridge::offered(const bridges::LiveChannel& channel) {
  const bool is_event = channel.type == kEvent;
  const std::string type(is_event ? kText : std::string_view(channel.type));
  if (!is_known_type(type)) return false;
  if (Out& out = out_[channel.topic]; out.type != type) {
    const bool is_latched = channel.topic.ends_with("/robot_description");
    out.publisher.reset();
    out.publisher =
        node_.publish(channel.topic, type, is_latched ? Delivery::kLatched : Delivery::kStream);
    out.type = type;
  }
  return true;
}

void Bridge::received(const bridges::LiveChannel& channel, std::string_view bytes) {
  Bytes message = std::as_bytes(std::span(bytes));
  Out& out = out_[channel.topic];
  if (channel.type == kEvent) {
    messages::Event event;
    if (!messages::CdrReader(message).decode(event)) return;
    message = cdr_.encode(messages::TextMessage{
        fmt::format("{:.3f} s  {}  {}", event.time_s, event.name, event.text)});
  }
  ++(out.publisher->publish(message) ? out.sent : out.refused);
}

void Bridge::offered(const bridges::LiveService& service) {
  if (options_.is_view || service.type != kTrigger) return;
  Offered& offered = services_[service.name];
  offered.id = service.id;
  if (!offered.service) {
    offered.service = node_.serve(service.name, service.type, [this] { arrived(); });
  }
}

void Bridge::withdrawn(const bridges::LiveService& service) {
  if (const auto found = services_.find(service.name); found != services_.end()) {
    found->second.id = 0;
  }
}

void Bridge::parameters(const nlohmann::json& values, const std::string& id) {
  if (parameters_) parameters_->take(values, id);
}

void Bridge::status(const std::string& text, bool /*is_error*/) {
  if (parameters_) parameters_->on_status(text);
  say_once("the run: " + text);
}

void Bridge::arrived() {
  if (is_due_.exchange(true)) return;
  boost::asio::post(context_, [this] { look_at_ros(); });
}

void Bridge::look_at_ros() {
  is_due_ = false;
  for (In& in : in_) pass_on(in);
  for (auto& [name, offered] : services_) {
    Request request;
    while (offered.service->take(request)) {
      if (!is_open_ || offered.id == 0) {
        refuse(name, request, "no run is connected");
        continue;
      }
      // a stop is never refused: it overtakes what waits
      const bool is_stop = name == kStop;
      if (!is_stop && calls_.size() >= kMostCalls) {
        refuse(name, request, "too many requests wait");
        continue;
      }
      calls_[++called_] = {name, request, Clock::now()};
      if (is_stop) {
        client_->call_at_once(offered.id, called_, text_of(request.message));
      } else {
        client_->call(offered.id, called_, text_of(request.message));
      }
    }
  }
  if (parameters_) {
    parameters_->pass_on(is_open_ ? [this](const nlohmann::json& json) { client_->send(json); }
                                  : Parameters::Send{});
  }
}

void Bridge::pass_on(In& in) {
  std::vector<std::byte> message, newest;
  while (in.subscription->take(message)) newest.swap(message);
  if (newest.empty() || !is_open_) return;
  if (in.offer == 0) in.offer = client_->offer(in.topic, in.type);
  client_->publish(in.offer, text_of(newest));
  ++in.sent;
}

void Bridge::answered(std::uint32_t call, std::string_view message) {
  const auto found = calls_.find(call);
  if (found == calls_.end()) return;
  answer(found->second.service, found->second.request, std::as_bytes(std::span(message)));
  calls_.erase(found);
}

void Bridge::failed(std::uint32_t call, const std::string& why) {
  const auto found = calls_.find(call);
  if (found == calls_.end()) return;
  refuse(found->second.service, found->second.request, why);
  calls_.erase(found);
}

void Bridge::refuse(const std::string& service, const Request& request, const std::string& why) {
  answer(service, request, cdr_.encode(messages::TriggerResponse{false, why}));
}

void Bridge::answer(const std::string& service, const Request& request, Bytes message) {
  if (services_.at(service).service->answer(request, message)) return;
  unsent_.push_back({service, request, {message.begin(), message.end()}, Clock::now()});
}

void Bridge::tick() {
  const auto now = Clock::now();
  if (!client_ && now >= next_try_) {
    next_try_ = now + kBetweenTries;
    connect();
  }
  // who publishes no longer has let go
  for (In& in : in_) {
    if (in.offer == 0 || in.subscription->publishers() > 0) continue;
    client_->withdraw(std::exchange(in.offer, 0));
  }
  std::erase_if(calls_, [&](const auto& item) {
    if (now - item.second.since < kPatience) return false;
    refuse(item.second.service, item.second.request, "the run does not answer");
    return true;
  });
  std::erase_if(unsent_, [&](const Unsent& one) {
    return services_.at(one.service).service->answer(one.request, one.message) ||
           now - one.since > kPatience;
  });
  if (parameters_) {
    parameters_->give_up("the run does not answer", false);
    parameters_->retry();
  }
}

void Bridge::say_once(const std::string& text) {
  if (std::exchange(said_, text) != text) say(text);
}

void Bridge::sum_up() const {
  for (const auto& [topic, out] : out_) {
    say(fmt::format("{:>9} messages out  {}{}", out.sent, node_.full_name(topic),
                    out.refused > 0 ? fmt::format(", {} refused by the DDS", out.refused) : ""));
  }
  for (const In& in : in_) {
    say(fmt::format("{:>9} messages in   {}", in.sent, node_.full_name(in.topic)));
  }
  const std::uint64_t dropped = dropped_ + (client_ ? client_->dropped() : 0);
  if (dropped > 0)
    say(fmt::format("{:>9} messages dropped: the run was too slow for them", dropped));
}

}  // namespace

void run_bridge(const BridgeOptions& options, const std::atomic<bool>& stop) {
  Bridge(options).run(stop);
}

}  // namespace hg::ros2

#include "bridge.h"

#include <geometry_msgs/TwistStamped.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include <array>
#include <boost/asio/post.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include "cdr.h"
#include "descriptions.h"

namespace hapticgiant {
namespace {

constexpr auto kTick = std::chrono::milliseconds(40);  // of moving markers
constexpr std::uint64_t kTicksPerSecond = 25;
constexpr auto kServicePatience = std::chrono::seconds(5);
constexpr int kQueue = 100;  // messages per subscriber; a slow one loses the oldest
constexpr std::array kServices = {"tare", "arm", "run", "stop", "reset", "mark"};
constexpr std::string_view kEmptyRequest("\0\1\0\0\0", 5);  // in CDR: one unused byte

std::string relative(const std::string& topic) { return topic.substr(1); }

// Event of a recording: time in s, name and text.
struct Event {
  double time_s = 0.0;
  std::string name, text;
};

bool decode(Bytes bytes, Event& event) {
  CdrReader reader(bytes);
  reader.next(event.time_s);
  reader.next(event.name);
  reader.next(event.text);
  return reader.is_ok();
}

int pid_of_master() {
  XmlRpc::XmlRpcValue arguments, response, pid;
  arguments[0] = ros::this_node::getName();
  return ros::master::execute("getPid", arguments, response, pid, false) ? static_cast<int>(pid)
                                                                         : 0;
}

}  // namespace

Bridge::Bridge(FindLink find_link, std::filesystem::path mesh_folder)
    : mesh_folder_(std::move(mesh_folder)),
      timer_(context_),
      settings_([this](const std::string& name, const nlohmann::json& value) {
        boost::asio::post(context_, [this, name, value] { client_->set_parameter(name, value); });
      }) {
  pass_on<sensor_msgs::JointState>("/joint_states",
                                   [this](const auto& joints) { joints_ = joints; });
  pass_on<sensor_msgs::JointState>("/twin/joint_states");
  pass_on<geometry_msgs::WrenchStamped>("/user_wrench",
                                        [this](const auto& wrench) { wrench_ = wrench; });
  pass_on<geometry_msgs::TwistStamped>("/handle_twist");
  pass_on<tf2_msgs::TFMessage>("/tf");
  pass_on<sensor_msgs::JointState>("/limits");
  pass_on<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", [this](const auto& message) { note_diagnostics(message); });
  pass_on_events();
  describe("/robot_description");
  describe("/twin/robot_description");
  markers_topic_ = node_.advertise<visualization_msgs::MarkerArray>("hapticgiant/markers", kQueue);
  if (ros::param::param("/use_sim_time", false)) {
    clock_ = node_.advertise<rosgraph_msgs::Clock>("/clock", kQueue);
  }
  take<geometry_msgs::PoseStamped>("/hand_target", "geometry_msgs/msg/PoseStamped");
  take<geometry_msgs::WrenchStamped>("/reference_wrench", "geometry_msgs/msg/WrenchStamped");
  for (const char* service : kServices) serve(std::string("/hapticgiant/") + service);

  std::vector<std::string> topics;
  for (const auto& [topic, handler] : handlers_) topics.push_back(topic);
  client_.emplace(context_, std::move(find_link), topics, publications_, live_events());
}

// A topic of the program as a topic of ROS; `also` sees its messages, too.
template <typename Message>
void Bridge::pass_on(const std::string& topic, std::function<void(const Message&)> also) {
  const ros::Publisher publisher = node_.advertise<Message>(relative(topic), kQueue);
  publishers_[topic] = publisher;
  handlers_[topic] = [topic, publisher, also](Bytes bytes) {
    const auto message = boost::make_shared<Message>();
    if (!from_cdr(bytes, *message)) {
      ROS_ERROR_THROTTLE(5.0, "%s: not a message of the expected type", topic.c_str());
      return;
    }
    publisher.publish(message);
    if (also) also(*message);
  };
}

void Bridge::pass_on_events() {
  const std::string topic = "/hapticgiant/events";
  const auto publisher = node_.advertise<std_msgs::String>(relative(topic), kQueue);
  publishers_[topic] = publisher;
  handlers_[topic] = [publisher](Bytes bytes) {
    Event event;
    if (!decode(bytes, event)) return;
    std_msgs::String text;
    text.data = event.text.empty() ? event.name : event.name + ": " + event.text;
    publisher.publish(text);
  };
}

// A URDF, which ROS 1 keeps as a parameter.
void Bridge::describe(const std::string& topic) {
  handlers_[topic] = [this, topic](Bytes bytes) {
    std_msgs::String urdf;
    if (!from_cdr(bytes, urdf)) return;
    if (topic == "/robot_description") {
      markers_.set_device(urdf.data);
      update_scene();
    }
    fetch_meshes(*client_, urdf.data, mesh_folder_, [this, topic](const std::string& text) {
      ros::param::set(node_.resolveName(relative(topic)), text);
      ROS_INFO("parameter %s is set", node_.resolveName(relative(topic)).c_str());
    });
  };
}

// A topic of ROS whose messages go to the program.
template <typename Message>
void Bridge::take(const std::string& topic, const std::string& type) {
  publications_.push_back({topic, type});
  subscribers_.push_back(node_.subscribe<Message>(
      relative(topic), 1, [this, topic](const boost::shared_ptr<const Message>& message) {
        boost::asio::post(
            context_, [this, topic, bytes = to_cdr(*message)] { client_->publish(topic, bytes); });
      }));
}

void Bridge::serve(const std::string& service) {
  const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> call =
      [this, service](auto&, auto& response) { return trigger(service, response); };
  auto options = ros::AdvertiseServiceOptions::create<std_srvs::Trigger>(
      relative(service), call, ros::VoidConstPtr(), nullptr);
  if (service == kStop) options.callback_queue = &stops_;
  services_.push_back(node_.advertiseService(options));
}

// On a thread of ROS: waits for the answer of the program.
bool Bridge::trigger(const std::string& service, std_srvs::Trigger::Response& response) {
  const auto answer = std::make_shared<std::promise<Answer>>();
  boost::asio::post(context_, [this, service, answer] {
    client_->call(service, kEmptyRequest,
                  [answer](const Answer& result) { answer->set_value(result); });
  });
  auto future = answer->get_future();
  if (future.wait_for(kServicePatience) != std::future_status::ready) {
    response.message = "no answer of the program";
  } else if (const Answer result = future.get(); !result.is_ok) {
    response.message = result.error;
  } else if (!from_cdr(result.bytes, response)) {
    response.message = "the answer of the program is not that of a Trigger";
  }
  return true;
}

LiveEvents Bridge::live_events() {
  LiveEvents events;
  events.opened = [this] { opened(); };
  events.closed = [this](const std::string& reason) { closed(reason); };
  events.message = [this](const std::string& topic, Bytes bytes) { handlers_.at(topic)(bytes); };
  events.time = [this](std::uint64_t time_ns) {
    if (!clock_) return;
    rosgraph_msgs::Clock clock;
    clock.clock.fromNSec(time_ns);
    clock_.publish(clock);
  };
  events.parameters = [this](const nlohmann::json& parameters, bool is_answer) {
    settings_.update(parameters, is_answer);
  };
  events.status = [](const std::string& text, bool is_error) {
    if (is_error) {
      ROS_ERROR_THROTTLE(1.0, "program: %s", text.c_str());
    } else {
      ROS_WARN_THROTTLE(1.0, "program: %s", text.c_str());
    }
  };
  return events;
}

void Bridge::opened() {
  ROS_INFO("connected to the program");
  is_open_ = true;
  last_reason_.clear();
}

void Bridge::closed(const std::string& reason) {
  is_open_ = false;
  if (reason == last_reason_) return;
  last_reason_ = reason;
  ROS_WARN("not connected to the program: %s; trying again", reason.c_str());
}

void Bridge::update_scene() {
  try {
    const Scene scene = parse_scene(client_->get("/scene.json"));
    markers_.set_scene(scene);
    settings_.set_scene(scene);
  } catch (const std::exception& error) {
    ROS_WARN("without the scene: %s", error.what());
  }
}

void Bridge::note_diagnostics(const diagnostic_msgs::DiagnosticArray& diagnostics) {
  for (const auto& status : diagnostics.status) {
    for (const auto& entry : status.values) {
      if (entry.key == "field_clear") markers_.set_field_clear(entry.value == "true");
    }
  }
}

bool Bridge::run() {
  ros::AsyncSpinner spinner(2);  // a service that waits leaves one for topics
  spinner.start();
  ros::AsyncSpinner stops(1, &stops_);  // a stop waits for no other service
  stops.start();
  std::thread watch([this] { watch_master(); });  // a master may be far away, and slow
  tick();
  context_.run();
  watch.join();
  return has_new_master_;
}

void Bridge::watch_master() {
  int first = 0;
  while (ros::ok() && !has_new_master_) {
    const int pid = pid_of_master();  // 0: it is away
    if (first == 0) first = pid;
    has_new_master_ = pid != 0 && pid != first;
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
}

void Bridge::tick() {
  if (!ros::ok() || has_new_master_) return context_.stop();
  if (is_open_ && markers_topic_.getNumSubscribers() > 0) {
    markers_topic_.publish(markers_.moving(joints_, wrench_));
  }
  if (ticks_++ % kTicksPerSecond == 0) tick_second();
  timer_.expires_after(kTick);
  timer_.async_wait([this](boost::system::error_code) { tick(); });
}

void Bridge::tick_second() {
  if (is_open_) return markers_topic_.publish(markers_.fixed());
  diagnostic_msgs::DiagnosticArray lost;
  lost.header.stamp = ros::Time::now();
  lost.status.resize(1);
  lost.status[0].level = diagnostic_msgs::DiagnosticStatus::STALE;
  lost.status[0].name = "hapticgiant";
  lost.status[0].message = "not connected to the program: " + last_reason_;
  publishers_.at("/diagnostics").publish(lost);
}

}  // namespace hapticgiant

#include "apps/ros2/robot_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <ranges>
#include <string_view>
#include <thread>
#include <utility>

#include "apps/ros2/messages.h"
#include "apps/ros2/speeds.h"
#include "hg/core/error.h"
#include "hg/core/histogram.h"
#include "hg/core/monotonic_clock.h"
#include "hg/core/visible.h"
#include "hg/device/device.h"
#include "hg/device/udp/device_server.h"
#include "hg/device/udp/key.h"
#include "hg/messages/cdr_reader.h"
#include "hg/messages/cdr_writer.h"
#include "hg/messages/ros_messages.h"

namespace hg::ros2 {
namespace {

constexpr int kLastWords = 3;           // zeros at an end: one may get lost
constexpr double kHandSilence_s = 0.2;  // a dead-man switch that says nothing is open
constexpr double kTooLate_s = 0.002;    // states older than this are felt
constexpr double kOtherClock_s = 1.0;   // an age beyond this is a difference of clocks

void say(const std::string& text) {
  std::fputs((visible(text) + "\n").c_str(), stdout);
  std::fflush(stdout);
}

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

// takes messages of a topic as they come, in a thread of the DDS
template <typename Message>
class Taken {
 public:
  Taken(Node& node, const std::string& topic, std::string_view type,
        std::function<void(const Message&)> use)
      : use_(std::move(use)), subscription_(node.subscribe(topic, type, [this] { arrived(); })) {
    is_ready_ = true;
    arrived();
  }
  int publishers() const { return subscription_->publishers(); }

 private:
  void arrived() {
    if (!is_ready_) return;
    const std::lock_guard lock(mutex_);
    while (subscription_->take(bytes_)) {
      if (messages::CdrReader(bytes_).decode(message_)) use_(message_);
    }
  }

  std::function<void(const Message&)> use_;
  std::mutex mutex_;
  std::vector<std::byte> bytes_;
  Message message_;
  std::atomic<bool> is_ready_ = false;
  std::unique_ptr<Subscription> subscription_;  // the first to end
};

class Robot final : public device::Device {
 public:
  Robot(Node& node, const RobotOptions& options)
      : options_(options),
        period_s_(1.0 / options.rate_Hz),
        q_(VectorM::Zero(static_cast<Eigen::Index>(options.joints.size()))),
        dq_(q_),
        tau_(q_),
        speeds_(0.5 * period_s_),
        commands_(
            node.publish(options.commands, "std_msgs/msg/Float64MultiArray", Delivery::kStream)),
        states_(node, options.states, "sensor_msgs/msg/JointState",
                [this](const messages::JointState& state) { take(state); }) {
    command_.data.assign(options.joints.size(), 0.0);
    if (!options.wrench.empty()) {
      wrenches_ = std::make_unique<Taken<messages::WrenchStamped>>(
          node, options.wrench, "geometry_msgs/msg/WrenchStamped",
          [this](const messages::WrenchStamped& wrench) { take(wrench); });
    }
    if (!options.dead_man.empty()) {
      hands_ = std::make_unique<Taken<Bool>>(node, options.dead_man, "std_msgs/msg/Bool",
                                             [this](const Bool& hand) { take(hand); });
    }
  }

  ~Robot() override { come_to_rest(); }

  void read(SensorFrame& sensors) noexcept override {
    const std::lock_guard lock(mutex_);
    const std::int64_t now = now_ns();
    sensors.sequence = ++samples_;
    sensors.time_s = period_s_ * static_cast<double>(samples_);
    // a state that is late is continued at its speed, as a lost datagram would be
    const double age = std::clamp(seconds(now - state_ns_), 0.0, options_.silence_s);
    sensors.q_m = q_ + age * dq_;
    sensors.dq_m = dq_;
    sensors.tau_m = tau_;
    sensors.theta_m = sensors.q_m;
    sensors.w_S = w_S_;
    sensors.answered_sequence = answered_;
    sensors.dead_man = !hands_ || (is_held_ && seconds(now - hand_ns_) < kHandSilence_s);
    is_silent_ = seconds(now - state_ns_) > options_.silence_s ||
                 (wrenches_ && seconds(now - wrench_ns_) > options_.silence_s);
    sensors.driver_fault = is_silent_ ? FaultCode::kDriveFault : FaultCode::kNone;
  }

  void write(const CommandFrame& command) noexcept override {
    {
      const std::lock_guard lock(mutex_);
      const bool moves = command.enable && !is_silent_;
      for (std::size_t i = 0; i < command_.data.size(); ++i) {
        const auto joint = static_cast<Eigen::Index>(i);
        double value = 0.0;
        if (moves && options_.has_torques) value = command.tau_m[joint];
        if (moves && !options_.has_torques) {
          value = command.dq_m[joint] + options_.gain * (command.q_m[joint] - q_[joint]);
        }
        command_.data[i] = std::isfinite(value) ? value : 0.0;
      }
      sent_ = command.sequence;
    }
    commands_->publish(cdr_.encode(command_));
  }

  // zeros, several times
  void come_to_rest() {
    std::ranges::fill(command_.data, 0.0);
    for (int i = 0; i < kLastWords; ++i) commands_->publish(cdr_.encode(command_));
  }

  bool has_state() const {
    const std::lock_guard lock(mutex_);
    return state_ns_ > 0 && (!wrenches_ || wrench_ns_ > 0);
  }

  bool is_heard() const { return commands_->subscribers() > 0; }

  // what the DDS does to time
  std::string link_text() {
    const std::lock_guard lock(mutex_);
    const Distribution gap = gaps_.distribution(), age = ages_.distribution();
    std::string text = fmt::format("states {:.1f} ms apart, 99.9 % {:.1f}, at most {:.1f} ms",
                                   1e3 * gap.median, 1e3 * gap.p99_9, 1e3 * gap.max);
    if (other_clock_ > ages_.count()) {
      text += "; their time stamps are of another clock";
    } else if (ages_.count() > 0) {
      text += fmt::format("; {:.2f} ms old on arrival, 99.9 % {:.2f}, at most {:.2f} ms",
                          1e3 * age.median, 1e3 * age.p99_9, 1e3 * age.max);
    }
    const double late = std::max(age.p99_9, gap.p99_9 - period_s_);
    if (late > kTooLate_s) {
      text += fmt::format(
          "\n    WARNING: delays of {:.1f} ms are felt as a shaking or soft wall; make the twin "
          "heavier and its walls softer, or drive the arm without ROS (docs/start/own_driver.md)",
          1e3 * late);
    }
    return text;
  }

 private:
  struct Bool {
    bool data = false;
    template <typename Archive, Is<Bool> T>
    friend void fields(Archive& a, T& message) {
      a("data", message.data);
    }
  };
  struct Dimension {
    std::string label;
    std::uint32_t size = 0, stride = 0;
    template <typename Archive, Is<Dimension> T>
    friend void fields(Archive& a, T& dimension) {
      a("label", dimension.label);
      a("size", dimension.size);
      a("stride", dimension.stride);
    }
  };
  struct Float64MultiArray {
    std::vector<Dimension> dim;
    std::uint32_t data_offset = 0;
    std::vector<double> data;
    template <typename Archive, Is<Float64MultiArray> T>
    friend void fields(Archive& a, T& array) {
      a("dim", array.dim);
      a("data_offset", array.data_offset);
      a("data", array.data);
    }
  };

  void take(const messages::JointState& state) {
    const std::lock_guard lock(mutex_);
    VectorM q = q_, dq = dq_, tau = tau_;
    const std::int64_t now = now_ns();
    const double gap = state_ns_ > 0 ? seconds(now - state_ns_) : 0.0;
    const std::int64_t stamp = 1'000'000'000 * std::int64_t{state.header.stamp.sec} +
                               std::int64_t{state.header.stamp.nanosec};
    bool has_speeds = true;
    for (std::size_t i = 0; i < options_.joints.size(); ++i) {
      const auto found = std::ranges::find(state.name, options_.joints[i]);
      const auto at = static_cast<std::size_t>(found - state.name.begin());
      if (found == state.name.end() || at >= state.position.size()) return;  // of other joints
      const auto joint = static_cast<Eigen::Index>(i);
      q[joint] = state.position[at];
      if (at < state.velocity.size() && std::isfinite(state.velocity[at])) {
        dq[joint] = state.velocity[at];
      } else {
        has_speeds = false;
      }
      if (at < state.effort.size() && std::isfinite(state.effort[at]))
        tau[joint] = state.effort[at];
    }
    if (!has_speeds && speeds_.see(q, stamp, now)) {
      for (std::size_t i = 0; i < options_.joints.size(); ++i) {
        const auto at = static_cast<std::size_t>(std::ranges::find(state.name, options_.joints[i]) -
                                                 state.name.begin());
        const auto joint = static_cast<Eigen::Index>(i);
        const bool is_given = at < state.velocity.size() && std::isfinite(state.velocity[at]);
        if (!is_given) dq[joint] = speeds_.speeds()[joint];
      }
    }
    q_ = q;
    dq_ = dq;
    tau_ = tau;
    if (gap > 0.0) gaps_.add(gap);
    state_ns_ = now;
    answered_ = sent_;
    timespec wall{};
    clock_gettime(CLOCK_REALTIME, &wall);
    const double age = static_cast<double>(wall.tv_sec - state.header.stamp.sec) +
                       1e-9 * (static_cast<double>(wall.tv_nsec) -
                               static_cast<double>(state.header.stamp.nanosec));
    if (age >= 0.0 && age < kOtherClock_s) {
      ages_.add(age);
    } else {
      ++other_clock_;
    }
  }

  void take(const messages::WrenchStamped& wrench) {
    const std::lock_guard lock(mutex_);
    const auto& [force, torque] = wrench.wrench;
    w_S_ << force.x, force.y, force.z, torque.x, torque.y, torque.z;
    wrench_ns_ = now_ns();
  }

  void take(const Bool& hand) {
    const std::lock_guard lock(mutex_);
    is_held_ = hand.data;
    hand_ns_ = now_ns();
  }

  const RobotOptions& options_;
  double period_s_;
  mutable std::mutex mutex_;  // the robot's side is threads of the DDS
  VectorM q_, dq_, tau_;
  Speeds speeds_;
  Vector6 w_S_ = Vector6::Zero();
  std::int64_t state_ns_ = 0, wrench_ns_ = 0, hand_ns_ = 0;
  std::uint64_t samples_ = 0, answered_ = 0, sent_ = 0, other_clock_ = 0;
  bool is_held_ = false, is_silent_ = true;
  Histogram gaps_, ages_;  // s
  Float64MultiArray command_;
  messages::CdrWriter cdr_;
  std::unique_ptr<Publisher> commands_;
  Taken<messages::JointState> states_;
  std::unique_ptr<Taken<messages::WrenchStamped>> wrenches_;
  std::unique_ptr<Taken<Bool>> hands_;
};

}  // namespace

void run_robot(const RobotOptions& options, const std::atomic<bool>& stop) {
  const auto n = options.joints.size();
  if (n != 6 && n != 7) {
    throw SetupError(fmt::format("--joints: expected the names of 6 or 7 joints, got {}", n));
  }
  Node node(options.node);
  Robot robot(node, options);
  const udp::Description description = {
      .device = options.name,
      .n_m = static_cast<std::uint32_t>(n),
      .rate_Hz = options.rate_Hz,
      .interface = options.has_torques ? udp::Interface::kTorque : udp::Interface::kPosition};
  udp::DeviceServer server(
      udp::parse_address("--listen", options.listen),
      {.actual = description,
       .server = "hapticgiant-ros2",
       .is_simulated = options.is_simulated,
       .key = options.key_file.empty() ? udp::Key() : udp::Key::from_file(options.key_file)});
  say(fmt::format("{} at {}: {} joints, {:g} Hz, {} to {}", options.name, server.address(), n,
                  options.rate_Hz, options.has_torques ? "efforts" : "velocities",
                  node.full_name(options.commands)));
  say("WARNING: ROS 2 has no watchdog here: when this program is killed, a controller continues "
      "with "
      "its last command. Set a command time-out in the robot.");
  say(fmt::format("waiting for {}{}", node.full_name(options.states),
                  options.wrench.empty() ? "" : " and " + node.full_name(options.wrench)));
  while (!stop.load() && !robot.has_state()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (stop.load()) return;
  say("the robot is there; waiting for a controller (hapticgiant run ... --device-address)");
  while (server.wait_for_client(stop)) {
    if (!robot.is_heard()) {
      say(fmt::format("WARNING: no controller listens to {}", node.full_name(options.commands)));
    }
    const udp::SessionReport report = server.serve(robot, stop);
    robot.come_to_rest();
    say(fmt::format("{}, {:.1f} s{}\n    {}", report.client,
                    static_cast<double>(report.periods) / options.rate_Hz,
                    report.end == udp::SessionEnd::kClientSilent ? ", which fell silent" : "",
                    robot.link_text()));
  }
}

}  // namespace hg::ros2

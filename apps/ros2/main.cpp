/// The program `hapticgiant-ros2`: connects a run with ROS 2, in a process of its own and without
/// ROS.

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/ros2/bridge.h"
#include "apps/ros2/robot_device.h"
#include "hg/core/error.h"

namespace {

using hg::apps::Command;
using hg::apps::number_within;
using hg::apps::Option;

constexpr int kInternalError = 1, kBadInput = 2;
constexpr int kLastDomain = 232;

std::atomic<bool> stop{false};

// what ROS 2 itself reads from the environment
bool is_local_by_environment() {
  const char* local = std::getenv("ROS_LOCALHOST_ONLY");
  const char* range = std::getenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
  return (local != nullptr && std::string(local) == "1") ||
         (range != nullptr && std::string(range) == "LOCALHOST");
}

// makes /NAME of a name of ROS 2
Option accept_name(Option option, const std::string& example) {
  return option
      .transform([](const std::string& text) { return text.starts_with('/') ? text : "/" + text; })
      .check([example](const std::string& text) -> std::string {
        if (hg::ros2::is_name(text.substr(1))) return "";
        return fmt::format("'{}' is no name of ROS 2 (letters, digits, _ and /): {}", text,
                           example);
      });
}

// options of a robot as a device
void add_device(Command command, hg::ros2::RobotOptions& robot) {
  const Command device = command.add_subcommand(
      "device", "A robot of ROS 2 as a device for hapticgiant run --device-address.");
  const auto add_topic = [device](const std::string& name, std::string& topic,
                                  const std::string& help) {
    return accept_name(device.add_option(name, topic, help), "for example /joint_states");
  };
  device.add_option("--joints", robot.joints, "names of the joints, in the order of the device")
      .delimiter(',')
      .required();
  device.add_option("--name", robot.name, "name of the device, as in its device.yaml")
      .capture_default_str();
  device.add_option("--rate-hz", robot.rate_Hz, "rate of the loop, Hz, 1 to 10000")
      .check(number_within(1.0, 10000.0))
      .capture_default_str();
  device.add_option("--listen", robot.listen, "HOST:PORT for the controller").capture_default_str();
  device.add_option("--key-file", robot.key_file, "secret that controllers must have, too");
  device.add_flag("--effort", robot.has_torques, "command efforts instead of velocities");
  add_topic("--states", robot.states, "topic of the robot's sensor_msgs/JointState")
      .capture_default_str();
  add_topic("--wrench", robot.wrench,
            "topic of the force/torque sensor, geometry_msgs/WrenchStamped: what the user does to "
            "the handle");
  add_topic("--commands", robot.commands, "topic of a std_msgs/Float64MultiArray")
      .capture_default_str();
  const Option dead_man =
      add_topic("--dead-man", robot.dead_man,
                "topic of the switch of the handle, std_msgs/Bool, 10 Hz or more");
  device.add_flag("--without-dead-man", robot.has_no_dead_man, "the handle has no such switch")
      .excludes(dead_man);
  device.add_option("--gain", robot.gain, "1/s, of the position error, for velocities; 0 to 1000")
      .check(number_within(0.0, 1000.0))
      .capture_default_str();
  device
      .add_option("--silence", robot.silence_s,
                  "s, 0.001 to 1; after so long without a state or wrench the run gets a fault")
      .check(number_within(0.001, 1.0))
      .capture_default_str();
  device.add_flag("--simulated", robot.is_simulated, "no machine moves: no start test is needed");
  device.fallthrough();  // for the options of every node
  device.callback([&robot] {
    for (auto joint = robot.joints.begin(); joint != robot.joints.end(); ++joint) {
      if (std::find(robot.joints.begin(), joint, *joint) == joint) continue;
      hg::apps::refuse_option("--joints", "names '" + *joint + "' twice");
    }
    if (robot.dead_man.empty() && !robot.has_no_dead_man) {
      hg::apps::refuse_option("device", "expected --dead-man TOPIC or --without-dead-man");
    }
  });
}

int fail(int code, const std::string& why) {
  hg::apps::print_error(why + "\n");
  return code;
}

}  // namespace

int main(int argc, char** argv) try {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    std::signal(signal, [](int) { stop = true; });
  }
  std::signal(SIGPIPE, SIG_IGN);

  hg::apps::Program program("Shows a run of HapticGiant to ROS 2, without ROS.",
                            "hapticgiant-ros2");
  const Command command = program.command();
  hg::ros2::BridgeOptions options;
  options.node.is_local = is_local_by_environment();
  command.add_option(
      "--live", options.live,
      "address of the live interface of a run; default: the newest run on this computer");
  command
      .add_option(
          "--domain", options.node.domain,
          fmt::format("domain of ROS 2, 0 to {}; default: ROS_DOMAIN_ID, or 0", kLastDomain))
      .envname("ROS_DOMAIN_ID")
      .check(hg::apps::whole_number(0, kLastDomain));
  accept_name(command.add_option("--namespace", options.node.space,
                                 "namespace of all topics, for example left"),
              "for example left");
  command.add_flag("--local", options.node.is_local,
                   "this computer only; also ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST");
  command.add_flag("--view", options.is_view, "topics out of the run only: nothing can change it");
  hg::ros2::RobotOptions robot;
  add_device(command, robot);
  if (const std::optional<int> code = program.parse(argc, argv)) return *code;
  if (command.has_subcommand()) {
    if (!options.live.empty() || options.is_view) {
      return fail(kBadInput,
                  "--live, --view: not possible with device, which connects with no run: a run "
                  "connects with it (hapticgiant run ... --device-address)");
    }
    robot.node = options.node;
    robot.node.name += "_device";
    hg::ros2::run_robot(robot, stop);
  } else {
    hg::ros2::run_bridge(options, stop);
  }
  return 0;
} catch (const hg::SetupError& error) {
  return fail(kBadInput, error.what());
} catch (const std::exception& error) {
  return fail(kInternalError, std::string("internal error: ") + error.what());
}

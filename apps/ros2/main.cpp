/// The program `hapticgiant-ros2`: connects a run with ROS 2, in a process of its own and without
/// ROS.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "apps/ros2/bridge.h"
#include "apps/ros2/robot_device.h"
#include "hg/core/error.h"
#include "hg/core/visible.h"

namespace {

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

// CLI::Range lets NaN pass
CLI::Validator number_within(double least, double most) {
  return {[least, most](std::string& text) {
            double number = 0.0;
            const bool is_number = CLI::detail::lexical_cast(text, number);
            if (is_number && number >= least && number <= most) return std::string();
            return fmt::format("expected a number from {:g} to {:g}, got {}", least, most, text);
          },
          fmt::format("NUMBER in [{:g} - {:g}]", least, most)};
}

// makes /NAME of a name of ROS 2
CLI::Validator ros_name(const char* example) {
  return {[example](std::string& text) {
            const std::string bare = text.starts_with('/') ? text.substr(1) : text;
            if (!hg::ros2::is_name(bare)) {
              return fmt::format("'{}' is no name of ROS 2 (letters, digits, _ and /): {}", text,
                                 example);
            }
            text = "/" + bare;
            return std::string();
          },
          ""};
}

// options of a robot as a device
CLI::App* add_device(CLI::App& app, hg::ros2::RobotOptions& robot) {
  CLI::App* device = app.add_subcommand(
      "device", "A robot of ROS 2 as a device for hapticgiant run --device-address.");
  device->add_option("--joints", robot.joints, "names of the joints, in the order of the device")
      ->delimiter(',')
      ->required();
  const CLI::Validator is_topic = ros_name("for example /joint_states");
  device->add_option("--name", robot.name, "name of the device, as in its device.yaml")
      ->capture_default_str();
  device->add_option("--rate-hz", robot.rate_Hz, "rate of the loop, Hz")
      ->check(number_within(1.0, 10000.0))
      ->capture_default_str();
  device->add_option("--listen", robot.listen, "HOST:PORT for the controller")
      ->capture_default_str();
  device->add_option("--key-file", robot.key_file, "secret that controllers must have, too");
  device->add_flag("--effort", robot.has_torques, "command efforts instead of velocities");
  device->add_option("--states", robot.states, "topic of the robot's sensor_msgs/JointState")
      ->transform(is_topic)
      ->capture_default_str();
  device
      ->add_option("--wrench", robot.wrench,
                   "topic of the force/torque sensor, geometry_msgs/WrenchStamped: what the user "
                   "does to the handle")
      ->transform(is_topic);
  device->add_option("--commands", robot.commands, "topic of a std_msgs/Float64MultiArray")
      ->transform(is_topic)
      ->capture_default_str();
  CLI::Option* dead_man =
      device
          ->add_option("--dead-man", robot.dead_man,
                       "topic of the switch of the handle, std_msgs/Bool, 10 Hz or more")
          ->transform(is_topic);
  device->add_flag("--without-dead-man", robot.has_no_dead_man, "the handle has no such switch")
      ->excludes(dead_man);
  device->add_option("--gain", robot.gain, "1/s, of the position error, for velocities")
      ->check(number_within(0.0, 1000.0))
      ->capture_default_str();
  device
      ->add_option("--silence", robot.silence_s,
                   "s; after so long without a state or wrench the run gets a fault")
      ->check(number_within(0.001, 1.0))
      ->capture_default_str();
  device->add_flag("--simulated", robot.is_simulated, "no machine moves: no start test is needed");
  device->fallthrough();  // for the options of every node
  device->callback([&robot] {
    for (auto joint = robot.joints.begin(); joint != robot.joints.end(); ++joint) {
      if (std::find(robot.joints.begin(), joint, *joint) == joint) continue;
      throw CLI::ValidationError("--joints", "names '" + *joint + "' twice");
    }
    if (robot.dead_man.empty() && !robot.has_no_dead_man) {
      throw CLI::ValidationError("device", "expected --dead-man TOPIC or --without-dead-man");
    }
  });
  return device;
}

int fail(int code, const std::string& why) {
  std::fputs((hg::visible(why) + "\n").c_str(), stderr);
  return code;
}

}  // namespace

int main(int argc, char** argv) try {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    std::signal(signal, [](int) { stop = true; });
  }
  std::signal(SIGPIPE, SIG_IGN);

  CLI::App app("Shows a run of HapticGiant to ROS 2, without ROS.", "hapticgiant-ros2");
  hg::ros2::BridgeOptions options;
  options.node.is_local = is_local_by_environment();
  app.add_option(
      "--live", options.live,
      "address of the live interface of a run; default: the newest run on this computer");
  app.add_option("--domain", options.node.domain, "domain of ROS 2; default: ROS_DOMAIN_ID, or 0")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, kLastDomain));
  app.add_option("--namespace", options.node.space, "namespace of all topics, for example left")
      ->transform(ros_name("for example left"));
  app.add_flag("--local", options.node.is_local,
               "this computer only; also ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST");
  app.add_flag("--view", options.is_view, "topics out of the run only: nothing can change it");
  hg::ros2::RobotOptions robot;
  const CLI::App* device = add_device(app, robot);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  if (device->parsed()) {
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

#include "apps/hapticgiant/bridge_command.h"

#include <array>
#include <string>

#include "apps/command_line/command.h"
#include "apps/hapticgiant/sibling_program.h"

namespace hg::apps {
namespace {

struct BridgeFacts {
  const char *name, *what, *source;  // source: where one gets it
};

constexpr std::array kBridges = {
    BridgeFacts{"ros2", "Shows a run to ROS 2, without ROS (docs/start/ros2.md).",
                "the Debian package of HapticGiant has it, a wheel has not; from source "
                "'make build' makes it where there is Fast DDS 2 (Debian: libfastrtps-dev)"},
    BridgeFacts{"ros1", "Shows a run to ROS 1 and rviz (docs/start/ros1.md).",
                "it is built from source where there is Debian's ROS 1, by bridges/ros1/build.sh"},
};

}  // namespace

void add_bridge(Command app) {
  const Command command =
      app.add_subcommand("bridge", "Shows runs of this computer to other tools while they last.");
  command.require_subcommand(1);
  for (const BridgeFacts& bridge : kBridges) {
    const Command one = command.add_subcommand(bridge.name, bridge.what);
    one.take_all_words();  // the bridge has its own --help
    one.callback([one, &bridge] {
      become_sibling(bridge.name, one.remaining(), std::string("bridge ") + bridge.name + ": off",
                     bridge.source);
    });
  }
}

}  // namespace hg::apps

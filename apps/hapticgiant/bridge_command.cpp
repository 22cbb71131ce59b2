#include "apps/hapticgiant/bridge_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/error.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

/// A bridge is the program hapticgiant-NAME beside this one.
struct BridgeFacts {
  const char *name, *what, *source;  // source: where one gets it
};

constexpr std::array kBridges = {
    BridgeFacts{
        "ros2", "Shows a run to ROS 2, without ROS (docs/start/ros2.md).",
        "the Debian package of HapticGiant has it, a wheel has not; from source it is built "
        "where there is Fast DDS 2 (Debian: libfastrtps-dev)"},
    BridgeFacts{"ros1", "Shows a run to ROS 1 and rviz (docs/start/ros1.md).",
                "it is built from source where there is Debian's ROS 1, by bridges/ros1/build.sh"},
};

/// Becomes the bridge; returns only by an exception.
void become(const BridgeFacts& bridge, const std::vector<std::string>& arguments) {
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  const fs::path program = own.parent_path() / (std::string("hapticgiant-") + bridge.name);
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  if (errno != ENOENT) throw SetupError(program.string() + ": " + std::strerror(errno));
  throw SetupError(fmt::format("bridge {}: off, since {} is missing: {}", bridge.name,
                               program.string(), bridge.source));
}

}  // namespace

void add_bridge(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("bridge", "Shows runs of this computer to other tools while they go on.");
  command->require_subcommand(1);
  for (const BridgeFacts& bridge : kBridges) {
    CLI::App* one = command->add_subcommand(bridge.name, bridge.what);
    one->prefix_command();
    one->set_help_flag();  // the bridge has its own
    one->callback([one, &bridge, &exit_code] {
      exit_code = 1;
      become(bridge, one->remaining());
    });
  }
}

}  // namespace hg::apps

/// Commands that are not needed beside a machine: the program hapticgiant-offline has them, behind
/// the name and the help of hapticgiant.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace hg::apps {

class Command;

struct OfflineCommand {
  std::string_view name, description;
};

inline constexpr std::array kOfflineCommands = {
    OfflineCommand{"export",
                   "A recording as a table (CSV, Parquet, HDF5), or as a rosbag2 folder."},
    OfflineCommand{"plot", "Figures of recordings, several over each other."},
    OfflineCommand{"compare",
                   "Differences of two recordings: events, forces, limits, vibration, timing."},
    OfflineCommand{"hqp", "The lexicographic QP solver on its own."},
    OfflineCommand{"identify", "Parameters of a device from measurements."},
    OfflineCommand{"experiment",
                   "The paper's experiments, and what the simulated device is like to hold "
                   "(docs/experiments, docs/concepts/simulator.md)."},
    OfflineCommand{"bench",
                   "How fast and how right solver, cycle and laws are; minutes "
                   "(docs/reports/benchmarks.md)."},
    OfflineCommand{"faults",
                   "Breaks the simulated machine on purpose, hundreds of times "
                   "(docs/concepts/safety.md)."},
    OfflineCommand{
        "haptify",
        "Table III of the paper on the simulated device: how good it is to hold; minutes."},
    OfflineCommand{
        "tune", "Filters and poles for the torque control of a device, with their proof; minutes."},
    OfflineCommand{"design",
                   "What a human arm can do, how well a device serves it, and the search for a "
                   "better one (docs/start/design.md)."}};

/// Description of the command `name`, which is one of them.
constexpr std::string_view offline_description(std::string_view name) {
  return std::ranges::find(kOfflineCommands, name, &OfflineCommand::name)->description;
}

/// Adds these commands to the program; each becomes hapticgiant-offline with the words of the
/// command line as they are.
void add_offline_commands(Command app, int argc, char** argv);

}  // namespace hg::apps

#include "hg/config/bus/machine_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "hg/config/bus/machine_schema.h"
#include "hg/config/file_kind.h"
#include "hg/config/loader.h"

namespace hg::config {
namespace {

// vendors of simulated slaves, but for the last byte: no maker has these numbers
constexpr std::uint32_t kSimulatedVendor = 0x00FFFF00;
constexpr std::uint32_t kVendorMask = 0xFFFFFF00;
constexpr double kLongestWatchdog_s = 0.1;

bool has_equal_names(const std::vector<ethercat::Slave>& slaves) {
  std::vector<std::string> names;
  for (const ethercat::Slave& slave : slaves) names.push_back(slave.name);
  std::ranges::sort(names);
  return std::ranges::adjacent_find(names) != names.end();
}

// Names of joints that no drive, or more than one, moves.
void check_joints(Loader& loader, const ethercat::Machine& machine,
                  const std::vector<std::string>& joints) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto drives =
        std::ranges::count(machine.slaves, static_cast<int>(i), &ethercat::Slave::joint);
    loader.rule(drives == 1, "slaves", "joint '" + joints[i] + "' must have one drive",
                std::to_string(drives));
  }
}

// Slaves of a maker are no simulation.
void check_simulation(Loader& loader, const ethercat::Machine& machine) {
  for (const ethercat::Slave& slave : machine.slaves) {
    loader.rule((slave.vendor & kVendorMask) == kSimulatedVendor, "moves_with_frames",
                "slave '" + slave.name +
                    "' is no simulated one (vendors 0x00ffff00 to 0x00ffffff): a machine keeps its "
                    "own time, and needs its start test");
  }
}

// What a machine with power must have.
void check_power(Loader& loader, const ethercat::Machine& machine) {
  loader.rule(machine.watchdog_s <= kLongestWatchdog_s, "watchdog_s",
              "must be at most 0.1 s: for so long drives go on with their last commands when this "
              "computer has stopped",
              fmt::format("{:g}", machine.watchdog_s));
  const bool has_drives = std::ranges::any_of(machine.slaves, [](const ethercat::Slave& slave) {
    return slave.mode != ethercat::DriveMode::kNone;
  });
  if (!has_drives) return;
  loader.rule(loader.is_given("brake_closing_s"), "brake_closing_s",
              "key 'brake_closing_s' is missing: how long brakes take to close, 0 where there are "
              "none");
  const bool has_button = std::ranges::any_of(machine.slaves, [](const ethercat::Slave& slave) {
    return has_entry(slave.inputs, ethercat::Input::kEmergencyStop);
  });
  loader.rule(has_button, "slaves",
              "no slave has the input 'emergency_stop': a machine with drives needs one");
}

// A value or switch of the frame, which two slaves would set in turn.
bool is_of_frame(ethercat::Input meaning) {
  return ethercat::Input::kForceX <= meaning && meaning != ethercat::Input::kSensorFault &&
         meaning != ethercat::Input::kSampleCounter;
}

// An input that is given once more: by the same slave, or for the same place of the frame.
void check_inputs_once(LoaderFile& file, const ethercat::Machine& machine) {
  struct Given {
    ethercat::Input meaning;
    std::size_t slave;
    int line;
  };
  std::vector<Given> given;
  for (std::size_t i = 0; i < machine.slaves.size(); ++i) {
    for (std::size_t k = 0; k < machine.slaves[i].inputs.size(); ++k) {
      const ethercat::Input meaning = machine.slaves[i].inputs[k].meaning;
      if (meaning == ethercat::Input::kNothing) continue;
      const std::string item = fmt::format("slaves[{}].inputs[{}].is", i, k);
      const Place place = file.places.nearest(item);
      const auto first = std::ranges::find_if(given, [&](const Given& other) {
        return other.meaning == meaning && (other.slave == i || is_of_frame(meaning));
      });
      if (first == given.end()) {
        given.push_back({meaning, i, place.line});
        continue;
      }
      file.faults.add(place, item,
                      fmt::format("slave '{}' gives this already in line {}, only one can count",
                                  machine.slaves[first->slave].name, first->line));
    }
  }
}

}  // namespace

ethercat::Machine load_machine(const std::filesystem::path& path, SourceReader& reader,
                               const std::vector<std::string>& joints, Places* places) {
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  file.knows_names = !joints.empty();
  ethercat::Machine machine;
  load_file_of_kind(FileKind::kMachine, file, [&](Loader& loader) {
    describe(loader, machine, joints);
    if (file.faults.count() > 0) return;
    loader.rule(!machine.slaves.empty(), "slaves", "must not be empty");
    loader.rule(!has_equal_names(machine.slaves), "slaves", "two slaves have the same name");
    check_joints(loader, machine, joints);
    if (machine.moves_with_frames) {
      check_simulation(loader, machine);
    } else {
      check_power(loader, machine);
    }
    check_inputs_once(file, machine);
  });
  if (places != nullptr) *places = std::move(file.places);
  return machine;
}

}  // namespace hg::config

#include "hg/scenario/remote/ethercat_setup.h"

#include <string_view>
#include <utility>
#include <vector>

#include "hg/config/bus/machine_file.h"
#include "hg/config/sources.h"
#include "hg/core/error.h"

namespace hg::scenario {
namespace {

constexpr std::string_view kScheme = "ethercat://";
constexpr const char* kFile = "machine.yaml";

using ethercat::DriveMode;

// How a drive must be led for what the controller commands.
DriveMode mode_for(const config::DeviceConfig& device, int joint) {
  if (joint < device.model.n_p) return DriveMode::kCsv;
  return device.control.method == tracking::Method::kDrives ? DriveMode::kCsp : DriveMode::kCst;
}

const char* name_of(DriveMode mode) {
  switch (mode) {
    case DriveMode::kCsp:
      return "csp";
    case DriveMode::kCsv:
      return "csv";
    case DriveMode::kCst:
      return "cst";
    case DriveMode::kNone:
      break;
  }
  return "none";
}

void check_modes(const std::filesystem::path& file, const ethercat::Machine& machine,
                 const config::DeviceConfig& device) {
  for (const ethercat::Slave& slave : machine.slaves) {
    if (slave.joint < 0) continue;
    const DriveMode needed = mode_for(device, slave.joint);
    if (slave.mode == needed) continue;
    throw SetupError(file.generic_string() + ": slave '" + slave.name + "': mode: " + device.name +
                     " commands it by " + name_of(needed) + ", got " + name_of(slave.mode));
  }
}

}  // namespace

bool is_ethercat(const std::string& address) { return address.starts_with(kScheme); }

ethercat::EthercatConfig ethercat_config(const std::string& address,
                                         const std::filesystem::path& file,
                                         const config::Scenario& scenario, bool is_fast) {
  const config::DeviceConfig& device = scenario.device;
  ethercat::EthercatConfig result{.interface_name = address.substr(kScheme.size()),
                                  .n_p = device.model.n_p,
                                  .n_m = device.model.n_m,
                                  .rate_Hz = device.model.rate_Hz,
                                  .is_fast = is_fast};
  if (result.interface_name.empty()) {
    throw SetupError("--device-address: expected ethercat://INTERFACE, got '" + address + "'");
  }
  if (!scenario.faults.empty()) {
    throw SetupError("faults: the device at " + address +
                     " is a machine, only a simulated one takes injected faults, got " +
                     std::string(scenario.faults.front().kind->name));
  }
  std::vector<std::string> joints;
  for (int i = 0; i < device.model.n_p + device.model.n_m; ++i) {
    joints.push_back(device.model.chain.joints()[i].name);
  }
  const std::filesystem::path device_file = device.sources.front().name;
  const std::filesystem::path used = file.empty() ? device_file.parent_path() / kFile : file;
  config::SourceReader reader;
  result.machine = config::load_machine(used, reader, joints);
  check_modes(used, result.machine, device);
  if (is_fast && !result.machine.moves_with_frames) {
    throw SetupError("--fast: " + result.machine.name + " keeps its own time, leave it out");
  }
  return result;
}

}  // namespace hg::scenario

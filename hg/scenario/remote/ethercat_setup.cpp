#include "hg/scenario/remote/ethercat_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "hg/config/bus/machine_file.h"
#include "hg/config/sources.h"
#include "hg/core/enumerators.h"
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
    throw SetupError(fmt::format("{}: slave '{}': mode: {} commands it by {}, got {}",
                                 file.generic_string(), slave.name, device.name, name_of(needed),
                                 name_of(slave.mode)));
  }
}

template <ethercat::Input kInput>
bool has_input(const ethercat::Slave& slave) {
  return std::ranges::any_of(
      slave.inputs, [](const ethercat::Entry<ethercat::Input>& e) { return e.meaning == kInput; });
}

// What the controller of this device measures of every joint.
template <ethercat::Input... kInputs>
void require_of_joints(const std::filesystem::path& file, const ethercat::Machine& machine,
                       const config::DeviceConfig& device) {
  const auto require = [&](const ethercat::Slave& slave, bool has_it, std::string_view name) {
    if (has_it) return;
    throw SetupError(
        fmt::format("{}: slave '{}': input '{}' is missing, which the control of {} needs",
                    file.generic_string(), slave.name, name, device.name));
  };
  for (const ethercat::Slave& slave : machine.slaves) {
    if (slave.joint < device.model.n_p) continue;
    (require(slave, has_input<kInputs>(slave), key_name<kInputs>()), ...);
  }
}

// What it measures somewhere.
template <ethercat::Input... kInputs>
void require_once(const std::filesystem::path& file, const ethercat::Machine& machine,
                  const config::DeviceConfig& device) {
  const auto require = [&](bool has_it, std::string_view name) {
    if (has_it) return;
    throw SetupError(fmt::format("{}: no slave has the input '{}', which {} needs",
                                 file.generic_string(), name, device.name));
  };
  (require(std::ranges::any_of(machine.slaves, &has_input<kInputs>), key_name<kInputs>()), ...);
}

void check_inputs(const std::filesystem::path& file, const ethercat::Machine& machine,
                  const config::DeviceConfig& device) {
  using enum ethercat::Input;
  require_of_joints<kLinkPosition, kLinkVelocity>(file, machine, device);
  if (device.control.method != tracking::Method::kDrives) {
    require_of_joints<kMotorPosition, kJointTorque>(file, machine, device);
  }
  require_once<kForceX, kForceY, kForceZ, kTorqueX, kTorqueY, kTorqueZ>(file, machine, device);
  if (device.monitor.has_dead_man) require_once<kDeadMan>(file, machine, device);
  if (device.estimation.wrench.has_imu) {
    require_once<kAccelerationX, kAccelerationY, kAccelerationZ>(file, machine, device);
    require_once<kAngularRateX, kAngularRateY, kAngularRateZ>(file, machine, device);
  }
}

// A frame that is waited for longer would be in the way of the next one, which may have to stop the
// drives.
void check_times(const std::filesystem::path& file, const ethercat::Machine& machine,
                 double rate_Hz) {
  if (machine.moves_with_frames || machine.answer_s * rate_Hz <= 1.0) return;
  throw SetupError(fmt::format("{}: answer_s: must be at most a period, {:g} s, got {:g}",
                               file.generic_string(), 1.0 / rate_Hz, machine.answer_s));
}

Contact reach(const LinkRequest& request, config::Scenario& scenario) {
  const ethercat::EthercatConfig config =
      ethercat_config(request.address, request.machine_file, scenario, request.is_fast);
  const bool is_simulated = config.machine.moves_with_frames;
  return {.is_simulated = is_simulated, .needs_start_test = !is_simulated, .open = [config] {
            return std::make_unique<ethercat::EthercatDevice>(config);
          }};
}

std::string note_on(const device::ConnectedDevice& /*device*/) {
  return "the machine file says that the segment is a simulation: no start test is required";
}

}  // namespace

const Transport kEthercatTransport = {
    .scheme = kScheme,
    .help = "ethercat://INTERFACE of a machine on a bus (docs/reference/ethercat.md)",
    .key_refusal = "a bus has no key",
    .simulation_refusal =
        "the segment is a simulation, whose stop button the bus does not reach; leave "
        "--device-address out",
    .reach = &reach,
    .note = &note_on};

ethercat::EthercatConfig ethercat_config(const std::string& address,
                                         const std::filesystem::path& file,
                                         config::Scenario& scenario, bool is_fast) {
  config::DeviceConfig& device = scenario.device;
  ethercat::EthercatConfig result{.interface_name = address.substr(kScheme.size()),
                                  .n_p = device.model.n_p,
                                  .n_m = device.model.n_m,
                                  .rate_Hz = device.model.rate_Hz,
                                  .is_fast = is_fast};
  if (result.interface_name.empty()) {
    throw SetupError("--device-address: expected ethercat://INTERFACE, got '" + address + "'");
  }
  refuse_faults(scenario, address);
  std::vector<std::string> joints;
  for (int i = 0; i < device.model.n_p + device.model.n_m; ++i) {
    joints.push_back(device.model.chain.joints()[i].name);
  }
  const std::filesystem::path device_file = device.sources.front().name;
  const std::filesystem::path used = file.empty() ? device_file.parent_path() / kFile : file;
  config::SourceReader reader;
  result.machine = config::load_machine(used, reader, joints);
  check_modes(used, result.machine, device);
  check_inputs(used, result.machine, device);
  check_times(used, result.machine, result.rate_Hz);
  if (is_fast && !result.machine.moves_with_frames) {
    throw SetupError("--fast: " + result.machine.name + " keeps its own time, leave it out");
  }
  for (const config::SourceText& text : reader.texts()) {
    device.sources.push_back(text);
    scenario.sources.push_back(text);
  }
  return result;
}

}  // namespace hg::scenario

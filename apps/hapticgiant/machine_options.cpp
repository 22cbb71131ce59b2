#include "apps/hapticgiant/machine_options.h"

#include <fmt/format.h>

#include <utility>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/doctor/gate.h"
#include "hg/runtime/control_thread.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/remote/ethercat_setup.h"
#include "hg/scenario/remote/franka_setup.h"
#include "hg/scenario/remote/remote_setup.h"

namespace hg::apps {

void add_machine_options(Command command, MachineOptions& options) {
  add_scenario_options(command, options.world);
  command.add_option("--device-address", options.device_address,
                     "HOST:PORT of a remote device instead of a simulated one, or "
                     "ethercat://INTERFACE of a machine on a bus");
  command
      .add_option("--machine", options.machine,
                  "machine.yaml of a bus; default: the one beside the device file")
      .needs("--device-address");
  command
      .add_option("--key-file", options.key_file,
                  "secret that the remote device has, too (docs/reference/device_protocol.md)")
      .needs("--device-address");
  command.add_flag("--fast", options.is_fast, "lock-step with a remote device that is simulated")
      .needs("--device-address");
  command
      .add_option("--priority", options.priority,
                  "SCHED_FIFO priority with a remote device, 1..99; 0: an ordinary thread")
      .check(number_that("from 0 to 99", [](double v) { return v >= 0.0 && v <= 99.0; }))
      .capture_default_str();
  command
      .add_option("--despite", options.despite,
                  "items of the doctor that are bad about this computer and are to be let pass, as "
                  "NAME,NAME")
      .delimiter(',')
      .allow_extra_args(false)
      .needs("--device-address");
  command.add_option("--recordings", options.recordings, "folder that keeps the result")
      .capture_default_str();
}

config::Scenario make_machine_scenario(const MachineOptions& options) {
  RunArguments run;
  run.world = options.world;
  run.device_address = options.device_address;
  run.recordings = options.recordings;
  config::Scenario scenario = make_scenario(run);
  doctor::check_items(options.despite);
  runtime::check_thread_options({.priority = options.priority});
  make_folder(options.recordings);
  return scenario;
}

namespace {

// What was let pass, in words. In lock-step a late computer does no harm.
std::string check_computer(const MachineOptions& options, const config::Scenario& scenario) {
  if (options.is_fast) return {};
  const std::string passed = doctor::check_ready(scenario.device.model.rate_Hz,
                                                 {.priority = options.priority}, options.despite);
  if (!passed.empty()) print_out(fmt::format("computer    {}\n", passed));
  return passed;
}

}  // namespace

Machine connect_machine(const MachineOptions& options, config::Scenario& scenario,
                        const std::string& command) {
  if (options.device_address.empty()) return {.device = scenario::make_simulated_device(scenario)};
  if (scenario::is_ethercat(options.device_address)) {
    const ethercat::EthercatConfig config = scenario::ethercat_config(
        options.device_address, options.machine, scenario, options.is_fast);
    if (config.machine.moves_with_frames) {
      throw SetupError(command +
                       ": the segment is a simulation, whose stop button the bus does not reach; "
                       "leave --device-address out");
    }
    const std::string computer = check_computer(options, scenario);
    auto connected = std::make_unique<ethercat::EthercatDevice>(config);
    device::ConnectedDevice* const remote = connected.get();
    return {.device = std::move(connected),
            .remote = remote,
            .is_simulated = false,
            .computer = computer};
  }
  const auto connect = [&](double busy_patience_s) {
    return scenario::connect_device(
        options.device_address, scenario::key_of(options.key_file), scenario,
        std::string("hapticgiant ") + command + " " + kVersion, options.is_fast, busy_patience_s);
  };
  auto connected = connect(0.0);
  const bool is_simulated = connected->welcome().is_simulated;
  std::string computer;
  if (!is_simulated && !options.is_fast) {
    connected->close(FaultCode::kNone);
    computer = check_computer(options, scenario);
    constexpr double kFarewell = 0.5;  // s, until the server knows that the session is over
    connected = connect(kFarewell);
  }
  device::ConnectedDevice* const remote = connected.get();
  return {.device = std::move(connected),
          .remote = remote,
          .is_simulated = is_simulated,
          .computer = computer};
}

}  // namespace hg::apps

#include "apps/hapticgiant/machine_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/scenario_options.h"
#include "hg/core/error.h"
#include "hg/doctor/gate.h"
#include "hg/runtime/control_thread.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/run/connection.h"
#include "hg/scenario/run/plan_options.h"
#include "hg/scenario/run/prepared_run.h"

namespace hg::apps {

void add_machine_options(Command command, MachineOptions& options) {
  add_scenario_options(command, options.world);
  command.add_option("--device-address", options.machine.address, address_help(true));
  command
      .add_option("--machine", options.machine.machine_file,
                  "machine.yaml of a bus; default: the one beside the device file")
      .needs("--device-address");
  command
      .add_option("--key-file", options.machine.key_file,
                  "secret that the remote device has, too (docs/reference/device_protocol.md)")
      .needs("--device-address");
  command
      .add_flag("--fast", options.timing.is_fast,
                "lock-step with a remote device that is simulated")
      .needs("--device-address");
  command
      .add_option("--priority", options.timing.priority,
                  "SCHED_FIFO priority with a remote device, 1..99; 0: an ordinary thread")
      .check(number_that(scenario::kPriorityRule))
      .capture_default_str();
  command
      .add_option("--despite", options.machine.despite,
                  "items of the doctor that are bad about this computer and are to be let pass, as "
                  "NAME,NAME")
      .delimiter(',')
      .allow_extra_args(false)
      .needs("--device-address");
  command.add_option("--recordings", options.folder, "folder that keeps the result")
      .capture_default_str();
}

std::string address_help(bool is_test) {
  std::vector<std::string> forms;
  for (const scenario::Transport* transport : scenario::transports()) {
    if (!is_test || transport->start_test_refusal.empty()) forms.emplace_back(transport->help);
  }
  forms.front() += " instead of a simulated one";
  forms.back().insert(0, "or ");
  return fmt::format("{}", fmt::join(forms, ", "));
}

void refuse_command(const MachineOptions& options, const std::string& command,
                    std::string_view scenario::Transport::*refusal) {
  if (options.machine.address.empty()) return;
  const std::string_view why = scenario::transport_of(options.machine.address).*refusal;
  if (!why.empty()) throw SetupError(fmt::format("{}: {}", command, why));
}

config::Scenario make_machine_scenario(const MachineOptions& options) {
  config::Scenario scenario = scenario::load_to_run(options.world, options.machine);
  doctor::check_items(options.machine.despite);
  runtime::check_thread_options({.priority = options.timing.priority});
  make_folder(options.folder);
  return scenario;
}

Machine connect_machine(const MachineOptions& options, config::Scenario& scenario,
                        const std::string& command) {
  if (options.machine.address.empty()) {
    return {.device = scenario::make_simulated_device(scenario)};
  }
  scenario::Connection connection =
      scenario::connect_to_test(options.machine, options.timing, scenario, command);
  if (!connection.computer.empty()) print_out("computer    {}\n", connection.computer);
  device::ConnectedDevice* const remote = connection.device.get();
  return {.device = std::move(connection.device),
          .remote = remote,
          .is_simulated = connection.is_simulated,
          .computer = connection.computer};
}

}  // namespace hg::apps

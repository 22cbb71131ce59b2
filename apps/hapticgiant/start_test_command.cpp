#include "apps/hapticgiant/start_test_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <memory>
#include <utility>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/runtime/control_thread.h"
#include "hg/start_test/device_station.h"
#include "hg/start_test/machine_memory.h"
#include "hg/start_test/memory.h"

namespace hg::apps {

int start_test(const MachineOptions& arguments) {
  refuse_command(arguments, "start-test", &scenario::Transport::start_test_refusal);
  config::Scenario scenario = make_machine_scenario(arguments);
  Machine machine = connect_machine(arguments, scenario, "start-test");
  device::ConnectedDevice* const remote = machine.remote;
  const bool is_simulated = machine.is_simulated;
  const std::string file = start_test::start_test_file(
      arguments.folder, scenario.device, is_simulated ? "" : arguments.machine.address);
  check_writable(file);

  const auto keep = [&](const std::vector<start_test::Item>& items) {
    const start_test::StartTestResult result = {
        .device = scenario.device.name,
        .address = arguments.machine.address,
        .version = kVersion,
        .files_sha256 = start_test::sha256_of(scenario.device),
        .ended = std::time(nullptr),
        .computer = machine.computer,
        .is_simulated = is_simulated,
        .has_passed = start_test::has_passed(items),
        .items = items};
    write_output(file, to_json(result));
  };
  keep({});  // whatever ends this program: an older result counts no more

  const std::atomic<bool>& interrupted = watch_interruption();
  start_test::DeviceStation station(scenario, std::move(machine.device), is_simulated, interrupted,
                                    [](double time_s, const std::string& words) {
                                      print_out(fmt::format("{:8.1f} s  {}\n", time_s, words));
                                    });
  const BackgroundOutput output(interrupted);
  print_out(fmt::format("HapticGiant {}  start test of {}{}\n", kVersion, scenario.device.name,
                        is_simulated ? ", simulated, with a simulated operator" : ""));
  print_out("stop        Ctrl-C\n");
  if (remote != nullptr && !arguments.timing.is_fast) {
    runtime::become_real_time({.priority = arguments.timing.priority});
  }
  const std::vector<start_test::Item> items =
      start_test::run(start_test::setup_of(scenario.device, is_simulated), station);
  station.release();
  if (remote != nullptr) remote->close(station.end());

  const bool has_passed = start_test::has_passed(items);
  keep(items);
  const auto count = [&](start_test::Outcome outcome) {
    return std::ranges::count(items, outcome, &start_test::Item::outcome);
  };
  print_out(fmt::format("\n  start test   {}: {} passed, {} failed, {} not tested\n",
                        has_passed ? "PASSED" : "FAILED", count(start_test::Outcome::kPassed),
                        count(start_test::Outcome::kFailed),
                        count(start_test::Outcome::kUntested)));
  print_out(fmt::format("  kept in      {}{}\n", file,
                        is_simulated ? " (of a simulation: counts for no machine)" : ""));
  if (station.end() != FaultCode::kNone) return 3;
  return has_passed ? 0 : 1;
}

void add_start_test(Command app, int& exit_code) {
  const auto arguments = std::make_shared<MachineOptions>();
  const Command command =
      app.add_subcommand("start-test",
                         "Brakes and stop inputs, step by step, before the first "
                         "run of a day (docs/reference/start_test.md).");
  command.footer(
      "Examples:\n"
      "  hapticgiant start-test                   the simulated device, with a simulated operator\n"
      "  hapticgiant start-test --device my_arm_device.yaml --device-address 192.168.1.20:4810");
  add_machine_options(command, *arguments);
  command.callback([arguments, &exit_code] { exit_code = start_test(*arguments); });
}

}  // namespace hg::apps

#include "apps/hapticgiant/commission_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <memory>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/terminal_crew.h"
#include "apps/hapticgiant/version.h"
#include "hg/commission/bring_up.h"
#include "hg/commission/simulated_crew.h"
#include "hg/core/error.h"
#include "hg/runtime/control_thread.h"
#include "hg/scenario/remote/transports.h"
#include "hg/start_test/machine_memory.h"
#include "hg/start_test/memory.h"

namespace hg::apps {
namespace {

using start_test::Outcome;

void print_step(double time_s, const std::string& words) {
  print_out(fmt::format("{:8.1f} s  {}\n", time_s, words));
}

std::unique_ptr<commission::Crew> make_crew(bool is_alone, const std::atomic<bool>& interrupted) {
  if (is_alone) return std::make_unique<commission::SimulatedCrew>(interrupted, print_step);
  return std::make_unique<TerminalCrew>(interrupted, print_step);
}

void print_title(const std::string& device, bool is_alone) {
  print_out(fmt::format("HapticGiant {}  first motions of {}{}\n", kVersion, device,
                        is_alone ? ", simulated, with a simulated person" : ""));
  if (is_alone) return;
  print_out(
      "keys        space bar, held: the machine may move; y, n: answers; Ctrl-C: drives off\n");
}

void print_result(const std::vector<commission::Item>& items, bool has_passed,
                  const std::string& file) {
  const auto count = [&](Outcome outcome) {
    return std::ranges::count(items, outcome, &commission::Item::outcome);
  };
  print_out(fmt::format("\n  commission   {}: {} passed, {} failed, {} not tested\n",
                        has_passed ? "PASSED" : "FAILED", count(Outcome::kPassed),
                        count(Outcome::kFailed), count(Outcome::kUntested)));
  print_out(fmt::format("  kept in      {}\n", file));
}

}  // namespace

int commission(const CommissionArguments& options) {
  refuse_command(options.machine, "commission", &scenario::Transport::commission_refusal);
  config::Scenario scenario = make_machine_scenario(options.machine);
  const std::atomic<bool>& interrupted = watch_interruption();
  Machine machine = connect_machine(options.machine, scenario, "commission");
  const std::string file =
      start_test::commission_file(options.machine.folder, scenario.device,
                                  machine.is_simulated ? "" : options.machine.machine.address);
  check_writable(file);
  const auto keep = [&](const std::vector<commission::Item>& items) {
    write_output(file, start_test::to_json({.device = scenario.device.name,
                                            .address = options.machine.machine.address,
                                            .version = kVersion,
                                            .files_sha256 = start_test::sha256_of(scenario.device),
                                            .ended = std::time(nullptr),
                                            .computer = machine.computer,
                                            .is_simulated = machine.is_simulated,
                                            .has_passed = start_test::has_passed(items),
                                            .items = items}));
  };
  keep({});  // whatever ends this program: an older result counts no more

  // what a device says of itself is not enough to move it without a person
  const bool is_alone =
      machine.remote == nullptr ||
      (machine.is_simulated && (options.machine.timing.is_fast || options.has_simulated_person));
  const std::unique_ptr<commission::Crew> crew = make_crew(is_alone, interrupted);
  const BackgroundOutput output(interrupted);
  print_title(scenario.device.name, is_alone);
  commission::Rig rig(scenario.device, *machine.device, *crew);
  if (machine.remote != nullptr && !options.machine.timing.is_fast) {
    runtime::become_real_time({.priority = options.machine.timing.priority});
  }
  commission::Options how = {
      .falls_silent = machine.remote != nullptr && !options.machine.timing.is_fast &&
                      scenario::transport_of(options.machine.machine.address).tests_silence};
  if (machine.remote != nullptr) how.filled_in = [&] { return machine.remote->counts().held; };
  const std::vector<commission::Item> items = commission::run(rig, how);
  if (machine.remote != nullptr) machine.remote->close(FaultCode::kNone);

  const bool has_passed = start_test::has_passed(items);
  keep(items);
  print_result(items, has_passed, file);
  return has_passed ? 0 : 1;
}

void add_commission(Command app, int& exit_code) {
  const auto options = std::make_shared<CommissionArguments>();
  const Command command =
      app.add_subcommand("commission",
                         "First motions of a new machine: is it connected as its file says? "
                         "(docs/reference/commission.md)");
  command.footer(
      "Examples:\n"
      "  hapticgiant commission                   the simulated device, with a simulated person\n"
      "  hapticgiant commission ur5e/open_drawer  the same of another arm: a scenario where it "
      "stands\n"
      "  hapticgiant commission --device my_arm_device.yaml --device-address 192.168.1.20:4810");
  add_machine_options(command, options->machine);
  command
      .add_flag("--simulated-person", options->has_simulated_person,
                "of a remote device that is simulated: no key is held, and no person is asked")
      .needs("--device-address");
  command.callback([options, &exit_code] { exit_code = commission(*options); });
}

}  // namespace hg::apps

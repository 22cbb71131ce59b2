#include "apps/hapticgiant/simulate_command.h"

#include <fmt/format.h>

#include <atomic>
#include <memory>
#include <string>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/simulate_remote.h"
#include "apps/hapticgiant/version.h"
#include "hg/analysis/summary.h"
#include "hg/device/udp/device_server.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/remote/remote_setup.h"
#include "hg/scenario/remote/watched_device.h"

namespace hg::apps {
namespace {

std::string how_it_ended(const udp::SessionReport& report) {
  switch (report.end) {
    case udp::SessionEnd::kClientLeft:
      return "the client left: " + report.farewell;
    case udp::SessionEnd::kClientSilent:
      return "NO COMMAND came in time: drives off, brakes closed";
    case udp::SessionEnd::kStopped:
      return "stopped here";
  }
  return {};
}

std::string closing_lines(const udp::SessionReport& report, double rate_Hz) {
  std::string text;
  const auto line = [&](const char* label, const std::string& value) {
    text += fmt::format("  {:<12} {}\n", label, value);
  };
  line("session",
       fmt::format("{}, {:.1f} s", report.client, static_cast<double>(report.periods) / rate_Hz));
  line("end", how_it_ended(report));
  line("answers",
       fmt::format("{:.3f} ms after the frame, at most {:.3f} ms; {} periods late",
                   1e3 * report.mean_answer_s, 1e3 * report.max_answer_s, report.overruns));
  line("link", analysis::link_text(report.link));
  if (!report.other.empty()) {
    line("others", fmt::format("{} datagrams of other senders ignored, the first from {}",
                               report.link.from_others, report.other));
  }
  return text;
}

}  // namespace

int simulate(const SimulateArguments& arguments) {
  check_writable(arguments.capture, kCapture);
  const config::Scenario scenario = scenario::load(arguments.world);
  const simulator::Simulation first_world = scenario::make_simulation(scenario);
  scenario::Start start = scenario::find_start(scenario.device, scenario.twin);
  const udp::ServerConfig config{.actual = scenario::describe(scenario, arguments.is_fast),
                                 .server = std::string("hapticgiant simulate ") + kVersion,
                                 .is_simulated = true,
                                 .capture = arguments.capture,
                                 .key = scenario::key_of(arguments.key_file)};
  udp::DeviceServer server(udp::parse_address("--listen", arguments.listen), config);
  const std::atomic<bool>& stop = watch_interruption();
  const BackgroundOutput output(stop);

  print_out(fmt::format("HapticGiant {}  {}, simulated\n", kVersion, scenario.title));
  print_out(fmt::format("address     {}\nstop        Ctrl-C\n", server.address()));
  std::string lost;  // reason why the capture is incomplete
  const auto check_capture = [&] {
    if (!lost.empty()) return;
    lost = server.capture_error();
    if (!lost.empty()) print_error("{}: the capture ended early: {}\n", arguments.capture, lost);
  };
  while (server.wait_for_client(stop)) {
    scenario::WatchedDevice device(
        scenario::make_simulated_device(
            scenario, arguments.stays ? scenario::make_simulation(scenario, start) : first_world),
        scenario.device.model);
    const udp::SessionReport report = server.serve(device, stop);
    print_out(fmt::format("\n{}  {:<12} {}\n", closing_lines(report, scenario.device.model.rate_Hz),
                          "truth", device.truth_text()));
    start = {device.truth_now().T_B_H, device.truth_now().q_p, device.truth_now().q_m};
    check_capture();
  }
  check_capture();
  return lost.empty() ? 0 : kNotWritten;
}

void add_simulate(Command app, int& exit_code) {
  const auto arguments = std::make_shared<SimulateArguments>();
  const Command command = app.add_subcommand(
      "simulate", "Device and person of a scenario for a controller elsewhere, over UDP.");
  command.footer(
      "Examples:\n"
      "  hapticgiant simulate door --listen 127.0.0.1:4810     then, in another terminal:\n"
      "  hapticgiant run door --device-address 127.0.0.1:4810");
  add_scenario_options(command, arguments->world);
  command
      .add_option("--listen", arguments->listen,
                  "HOST:PORT to serve at; whoever can reach it can move the device, or has to have "
                  "the key")
      .required();
  command.add_option("--key-file", arguments->key_file,
                     "secret that clients must have, too (docs/reference/device_protocol.md)");
  command.add_flag("--fast", arguments->is_fast,
                   "lock-step: each side waits for the other (run --fast) instead of real time");
  command.add_flag("--stays", arguments->stays,
                   "like a machine: each client finds the device where the last one has left it, "
                   "and the person lets go of the handle once the override key is on (run "
                   "--move-to-start)");
  command
      .add_flag("--remote", arguments->is_remote,
                "the remote machine of the scenario's teleoperation, for a leader elsewhere whose "
                "scenario has teleoperation.remote.udp")
      .excludes("--stays");
  command.add_option("--capture", arguments->capture,
                     "write every datagram to this pcap file (docs/reference/device_protocol.md)");
  command.callback([arguments, &exit_code] {
    exit_code = arguments->is_remote ? simulate_remote(*arguments) : simulate(*arguments);
  });
}

}  // namespace hg::apps

#include "apps/hapticgiant/simulate_remote.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <string>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/version.h"
#include "hg/analysis/summary.h"
#include "hg/core/monotonic_clock.h"
#include "hg/core/schedule.h"
#include "hg/scenario/remote/remote_machine.h"
#include "hg/scenario/remote/remote_setup.h"

namespace hg::apps {
namespace {

// True state at the end, by the simulation.
std::string truth_text(const teleoperation::MachineState& state) {
  return fmt::format("at {:.4f}, speed {:.4f}, force {:.2f}",
                     fmt::join(state.x.begin(), state.x.end(), " "), state.v.norm(),
                     state.f.norm());
}

}  // namespace

int simulate_remote(const SimulateArguments& arguments) {
  check_writable(arguments.capture, kCapture);
  const config::Scenario scenario = scenario::load(arguments.world);
  teleoperation::RemoteServerConfig config =
      scenario::remote_server_of(scenario, arguments.is_fast);
  config.server = std::string("hapticgiant simulate ") + kVersion;
  config.capture = arguments.capture;
  config.key = scenario::key_of(arguments.key_file);
  const double rate_Hz = config.description.rate_Hz;
  teleoperation::SimulatedMachine machine(scenario.teleoperation->machine, 1.0 / rate_Hz);
  teleoperation::RemoteServer server(udp::parse_address("--listen", arguments.listen), config);
  const std::atomic<bool>& stop = watch_interruption();
  const BackgroundOutput output(stop);
  print_out(
      fmt::format("HapticGiant {}  {}, its remote machine, simulated\n", kVersion, scenario.title));
  print_out(fmt::format("address     {}\nstop        Ctrl-C\n", server.address()));

  Schedule schedule(now_ns(), std::llround(1e9 / rate_Hz));
  teleoperation::MachineState state;
  teleoperation::RemoteTarget target;
  while (!stop.load()) {
    machine.read(state);
    const bool had_leader = server.has_leader();
    if (server.step(state, target)) machine.write(target);
    const std::string news = server.news();
    if (!news.empty()) print_out(news);
    if (had_leader && !server.has_leader()) {
      print_out(fmt::format("  {:<12} {}\n  {:<12} {}\n", "truth", truth_text(state), "link",
                            analysis::link_text(server.counts())));
    }
    if (arguments.is_fast) continue;
    schedule.advance(now_ns());
    sleep_until(schedule.due_ns());
  }
  const std::string lost = server.capture_error();
  if (lost.empty()) return 0;
  print_error("{}: the capture ended early: {}\n", arguments.capture, lost);
  return kNotWritten;
}

}  // namespace hg::apps

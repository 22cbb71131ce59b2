#include "apps/hapticgiant/simulate_command.h"

#include <fmt/format.h>

#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/remote_setup.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/status_line.h"
#include "apps/hapticgiant/version.h"
#include "hg/assembly/assembly.h"
#include "hg/evaluation/summary.h"
#include "hg/remote/device_server.h"

namespace hg::apps {
namespace {

std::string how_it_ended(const remote::SessionReport& report) {
  switch (report.end) {
    case remote::SessionEnd::kClientLeft:
      return "the client left: " + report.farewell;
    case remote::SessionEnd::kClientSilent:
      return "NO COMMAND came in time: drives off, brakes closed";
    case remote::SessionEnd::kStopped:
      return "stopped here";
  }
  return {};
}

std::string closing_lines(const remote::SessionReport& report, double rate_Hz) {
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
  line("link", evaluation::link_text(report.link));
  return text;
}

}  // namespace

int simulate(const SimulateArguments& arguments) {
  check_writable(arguments.capture);
  const config::Scenario scenario = make_scenario({.scenario = arguments.scenario,
                                                   .device = arguments.device,
                                                   .twin = arguments.twin,
                                                   .user = arguments.user,
                                                   .rate_Hz = arguments.rate_Hz});
  const device::SimulatedDevice world = assembly::make_simulated_device(scenario);
  const remote::ServerConfig config{.actual = describe(scenario, arguments.is_fast),
                                    .server = std::string("hapticgiant simulate ") + kVersion,
                                    .capture = arguments.capture};
  remote::DeviceServer server(remote::parse_address("--listen", arguments.listen), config);
  const std::atomic<bool>& stop = watch_interruption();

  print_out(fmt::format("HapticGiant {}  {}, simulated\n", kVersion, scenario.title));
  print_out(fmt::format("address     {}\nstop        Ctrl-C\n", server.address()));
  while (server.wait_for_client(stop)) {
    device::SimulatedDevice device = world;
    const remote::SessionReport report = server.serve(device, stop);
    print_out(fmt::format("\n{}", closing_lines(report, scenario.device.rate_Hz)));
  }
  return 0;
}

}  // namespace hg::apps

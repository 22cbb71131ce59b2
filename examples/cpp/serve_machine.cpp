// A machine of one's own for controllers elsewhere. Arguments: its device.yaml, and HOST:PORT.
#include <atomic>
#include <csignal>
#include <cstdio>

#include "hg/config/device.h"
#include "hg/core/error.h"
#include "hg/device/udp/device_server.h"
#include "my_robot.h"

namespace {

std::atomic<bool> stop{false};

}  // namespace

int main(int count, char** arguments) try {
  if (count != 3) return 2;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop = true; });
  const hg::config::DeviceConfig device = hg::config::load_device(arguments[1]);
  const hg::udp::Description description = {
      .device = device.name,
      .n_p = static_cast<std::uint32_t>(device.model.n_p),
      .n_m = static_cast<std::uint32_t>(device.model.n_m),
      .rate_Hz = device.model.rate_Hz,
      .interface = hg::udp::Interface::kPosition};  // kTorque: its drives take torques
  // true: this stand-in has no brakes. Yours: false, so that a start test tries them before a run
  hg::udp::DeviceServer server(
      hg::udp::parse_address("HOST:PORT", arguments[2]),
      {.actual = description, .server = "serve_machine", .is_simulated = true});
  std::printf("%s\n", server.address().c_str());
  std::fflush(stdout);
  MyRobot robot(hg::VectorM{{0.0, 0.6, 1.2, 0.0, 0.8, 0.0}}, device.model.dt());
  while (server.wait_for_client(stop)) {
    const hg::udp::SessionReport report = server.serve(robot, stop);
    std::printf("%d periods for %s\n", static_cast<int>(report.periods), report.client.c_str());
    std::fflush(stdout);
  }
} catch (const hg::SetupError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

// A machine of one's own for controllers elsewhere. Arguments: its device.yaml, HOST:PORT, and
// --simulated where no machine moves: then no start test is asked for.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "hg/config/device.h"
#include "hg/core/error.h"
#include "hg/device/udp/device_server.h"
#include "robot.h"

namespace {

// FILL IN. kTorque: the drives take torques.
constexpr hg::udp::Interface kInterface = hg::udp::Interface::kPosition;

std::atomic<bool> stop{false};

}  // namespace

int main(int count, char** arguments) try {
  const bool is_simulated = count == 4 && std::strcmp(arguments[3], "--simulated") == 0;
  if (count != 3 && !is_simulated) {
    std::fprintf(stderr, "usage: %s DEVICE.yaml HOST:PORT [--simulated]\n", arguments[0]);
    return 2;
  }
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop = true; });
  const hg::config::DeviceConfig device = hg::config::load_device(arguments[1]);
  const hg::udp::Description description = {.device = device.name,
                                            .n_p = static_cast<std::uint32_t>(device.model.n_p),
                                            .n_m = static_cast<std::uint32_t>(device.model.n_m),
                                            .rate_Hz = device.model.rate_Hz,
                                            .interface = kInterface};
  hg::udp::DeviceServer server(
      hg::udp::parse_address("HOST:PORT", arguments[2]),
      {.actual = description, .server = "my_driver", .is_simulated = is_simulated});
  std::printf("%s\n", server.address().c_str());
  std::fflush(stdout);
  // FILL IN: the constructor of yours. The stand-in of six joints begins at these positions, rad.
  MyRobot robot(hg::VectorM{{0.0, 0.6, 1.2, 0.0, 0.8, 0.0}}, device.model.dt());
  while (server.wait_for_client(stop)) {
    const hg::udp::SessionReport report = server.serve(robot, stop);
    std::printf("%d periods for %s%s\n", static_cast<int>(report.periods), report.client.c_str(),
                report.end == hg::udp::SessionEnd::kClientSilent ? ", which fell silent" : "");
    std::fflush(stdout);
  }
} catch (const hg::SetupError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

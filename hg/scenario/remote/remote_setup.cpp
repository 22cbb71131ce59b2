#include "hg/scenario/remote/remote_setup.h"

#include <utility>

namespace hg::scenario {
namespace {

constexpr double kFarewell = 0.5;  // s, until a server knows that a session is over

Contact reach(const LinkRequest& request, config::Scenario& scenario) {
  const auto connect = [=, &scenario](double busy_patience_s) {
    return connect_device(request.address, key_of(request.key_file), scenario, request.client,
                          request.is_fast, busy_patience_s);
  };
  auto first = connect(request.follows_session ? kFarewell : 0.0);
  const bool is_simulated = first->welcome().is_simulated;
  return {.is_simulated = is_simulated,
          .needs_start_test = !is_simulated,
          .session = std::move(first),
          .open = [connect] { return connect(kFarewell); }};
}

std::string note_on(const device::ConnectedDevice& /*device*/) {
  return "the device says that it is a simulation: no start test is required";
}

}  // namespace

const Transport kUdpTransport = {.help = "HOST:PORT of a remote device (hapticgiant simulate)",
                                 .tests_silence = true,
                                 .reach = &reach,
                                 .note = &note_on};

udp::Description describe(const config::Scenario& scenario, bool is_lock_step) {
  const config::DeviceConfig& device = scenario.device;
  const bool has_drives = device.control.method == tracking::Method::kDrives;
  return {.device = device.name,
          .n_p = static_cast<std::uint32_t>(device.model.n_p),
          .n_m = static_cast<std::uint32_t>(device.model.n_m),
          .rate_Hz = device.model.rate_Hz,
          .interface = has_drives ? udp::Interface::kPosition : udp::Interface::kTorque,
          .is_lock_step = is_lock_step};
}

udp::Key key_of(const std::string& file) {
  return file.empty() ? udp::Key() : udp::Key::from_file(file);
}

std::unique_ptr<udp::RemoteDevice> connect_device(const std::string& address, const udp::Key& key,
                                                  const config::Scenario& scenario,
                                                  const std::string& client, bool is_lock_step,
                                                  double busy_patience_s) {
  const udp::ClientConfig config{.expected = describe(scenario, is_lock_step),
                                 .client = client,
                                 .busy_patience_s = busy_patience_s,
                                 .key = key};
  auto device =
      std::make_unique<udp::RemoteDevice>(udp::parse_address("--device-address", address), config);
  if (!device->welcome().is_simulated) refuse_faults(scenario, address);
  return device;
}

}  // namespace hg::scenario

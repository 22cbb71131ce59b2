#include "hg/scenario/remote/remote_setup.h"

#include "hg/core/error.h"

namespace hg::scenario {

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
  if (!device->welcome().is_simulated && !scenario.faults.empty()) {
    throw SetupError("faults: the device at " + address +
                     " is a machine, only a simulated one takes injected faults, got " +
                     std::string(scenario.faults.front().kind->name));
  }
  return device;
}

}  // namespace hg::scenario

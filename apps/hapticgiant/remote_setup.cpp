#include "apps/hapticgiant/remote_setup.h"

#include "apps/hapticgiant/version.h"

namespace hg::apps {

remote::Description describe(const config::Scenario& scenario, bool is_lock_step) {
  const config::Device& device = scenario.device;
  const bool has_drives = device.control.method == control::Method::kDrives;
  return {.device = device.name,
          .n_p = static_cast<std::uint32_t>(device.model.n_p),
          .n_m = static_cast<std::uint32_t>(device.model.n_m),
          .rate_Hz = device.rate_Hz,
          .interface = has_drives ? remote::Interface::kPosition : remote::Interface::kTorque,
          .is_lock_step = is_lock_step};
}

remote::Key key_of(const std::string& file) {
  return file.empty() ? remote::Key() : remote::Key::from_file(file);
}

std::unique_ptr<remote::RemoteDevice> connect_device(const std::string& address,
                                                     const remote::Key& key,
                                                     const config::Scenario& scenario,
                                                     bool is_lock_step, double busy_patience_s) {
  const remote::ClientConfig config{.expected = describe(scenario, is_lock_step),
                                    .client = std::string("hapticgiant run ") + kVersion,
                                    .busy_patience_s = busy_patience_s,
                                    .key = key};
  return std::make_unique<remote::RemoteDevice>(remote::parse_address("--device-address", address),
                                                config);
}

}  // namespace hg::apps

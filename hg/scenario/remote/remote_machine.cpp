#include "hg/scenario/remote/remote_machine.h"

#include "hg/core/enumerators.h"
#include "hg/core/error.h"
#include "hg/scenario/remote/remote_setup.h"
#include "hg/teleoperation/remote_udp/udp_remote.h"

namespace hg::scenario {
namespace {

teleoperation::RemoteDescription describe_remote(
    const teleoperation::TeleoperationConfig& teleoperation, double rate_Hz, bool is_lock_step) {
  return {.coordinates = words_of(teleoperation.mapping),
          .size = static_cast<int>(teleoperation.machine.x_start.size()),
          .rate_Hz = rate_Hz,
          .is_lock_step = is_lock_step};
}

}  // namespace

std::unique_ptr<teleoperation::RemoteSide> connect_remote_machine(const config::Scenario& scenario,
                                                                  const std::string& client,
                                                                  bool is_lock_step) {
  if (!scenario.teleoperation || scenario.teleoperation->address.udp.empty()) return nullptr;
  const teleoperation::RemoteAddress& address = scenario.teleoperation->address;
  return std::make_unique<teleoperation::UdpRemote>(
      udp::parse_address("teleoperation.remote.udp", address.udp),
      teleoperation::UdpRemoteConfig{
          .description =
              describe_remote(*scenario.teleoperation, scenario.device.model.rate_Hz, is_lock_step),
          .method = scenario.teleoperation->method,
          .client = client,
          .key = key_of(address.key_file)});
}

teleoperation::RemoteServerConfig remote_server_of(const config::Scenario& scenario,
                                                   bool is_lock_step) {
  if (!scenario.teleoperation) {
    throw SetupError("--remote: " + scenario.title +
                     " has no teleoperation; remote_arm and teleoperation have one");
  }
  return {.description =
              describe_remote(*scenario.teleoperation, scenario.device.model.rate_Hz, is_lock_step),
          .impedance = scenario.teleoperation->machine.impedance,
          .limiter = scenario.teleoperation->limiter};
}

}  // namespace hg::scenario

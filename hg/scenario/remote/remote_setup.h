/// Sets up either end of a connection to a remote device from a scenario.
#pragma once

#include <memory>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/device/udp/remote_device.h"
#include "hg/scenario/remote/transports.h"

namespace hg::scenario {

/// A device behind the device protocol, HOST:PORT (docs/reference/device_protocol.md).
extern const Transport kUdpTransport;

/// Description of the scenario's device, required or offered.
udp::Description describe(const config::Scenario& scenario, bool is_lock_step);

/// Key of --key-file; none without a file. Throws SetupError.
udp::Key key_of(const std::string& file);

/// The scenario's device behind `address` (HOST:PORT of --device-address). `client` is the name
/// that the device is given. A device busy with another client is retried for `busy_patience_s`.
/// Throws SetupError, also where the scenario injects faults and the device is a machine.
std::unique_ptr<udp::RemoteDevice> connect_device(const std::string& address, const udp::Key& key,
                                                  const config::Scenario& scenario,
                                                  const std::string& client, bool is_lock_step,
                                                  double busy_patience_s = 0.0);

}  // namespace hg::scenario

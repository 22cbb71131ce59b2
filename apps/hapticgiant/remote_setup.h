/// From a scenario to either end of a connection to a remote device.
#pragma once

#include <memory>
#include <string>

#include "hg/config/scenario.h"
#include "hg/remote/remote_device.h"

namespace hg::apps {

/// What the scenario's device must be, or is.
remote::Description describe(const config::Scenario& scenario, bool is_lock_step);

/// The key of --key-file; none without a file. Throws SetupError.
remote::Key key_of(const std::string& file);

/// The scenario's device behind `address` (HOST:PORT of --device-address). One that has another
/// client is asked again for `busy_patience_s`. Throws SetupError.
std::unique_ptr<remote::RemoteDevice> connect_device(const std::string& address,
                                                     const remote::Key& key,
                                                     const config::Scenario& scenario,
                                                     bool is_lock_step,
                                                     double busy_patience_s = 0.0);

}  // namespace hg::apps

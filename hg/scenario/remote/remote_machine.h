/// Sets up either end of the link to the remote machine of a scenario's teleoperation.
#pragma once

#include <memory>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/teleoperation/remote_side.h"
#include "hg/teleoperation/remote_udp/remote_server.h"

namespace hg::scenario {

/// The remote machine of the scenario where it is behind a network; null: it is simulated here, or
/// there is none. `client` is the name that the machine is given. Throws SetupError.
std::unique_ptr<teleoperation::RemoteSide> connect_remote_machine(const config::Scenario& scenario,
                                                                  const std::string& client,
                                                                  bool is_lock_step);

/// Set-up data to serve the scenario's simulated remote machine. Throws SetupError: it has none.
teleoperation::RemoteServerConfig remote_server_of(const config::Scenario& scenario,
                                                   bool is_lock_step);

}  // namespace hg::scenario

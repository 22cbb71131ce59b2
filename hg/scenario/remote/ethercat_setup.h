/// Sets up a machine on an EtherCAT bus as the device of a scenario.
#pragma once

#include <filesystem>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/device/ethercat/ethercat_device.h"
#include "hg/scenario/remote/transports.h"

namespace hg::scenario {

/// A machine on a bus: ethercat://INTERFACE.
extern const Transport kEthercatTransport;

/// Set-up data of the machine of a scenario. `file` is its machine.yaml; empty: the one beside the
/// device file. From then on this file is one of those that describe the device (sources of device
/// and scenario). Throws SetupError where machine and device do not fit.
ethercat::EthercatConfig ethercat_config(const std::string& address,
                                         const std::filesystem::path& file,
                                         config::Scenario& scenario, bool is_fast);

}  // namespace hg::scenario

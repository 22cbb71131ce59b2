/// Sets up a Franka behind its research interface as the device of a scenario.
#pragma once

#include <memory>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/device/franka/franka_device.h"
#include "hg/scenario/remote/transports.h"

namespace hg::scenario {

/// A Franka: franka://HOST or franka://HOST:PORT, with /speeds behind it where the robot is led by
/// speeds instead of torques.
extern const Transport kFrankaTransport;

/// Set-up data of the Franka of a scenario. Throws SetupError where the scenario's device is none:
/// other joints or rate, torques of its own, a payload that the robot subtracts itself, no tool.
franka::FrankaConfig franka_config(const std::string& address, const config::Scenario& scenario);

/// The scenario's device as the Franka behind `address`. Throws SetupError.
std::unique_ptr<franka::FrankaDevice> connect_franka(const std::string& address,
                                                     const config::Scenario& scenario);

}  // namespace hg::scenario

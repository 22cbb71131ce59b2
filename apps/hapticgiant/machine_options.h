/// The machine, or its simulation, that a command without a twin talks to.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hg/config/simulation/scenario.h"
#include "hg/device/connected_device.h"
#include "hg/scenario/options.h"
#include "hg/scenario/remote/transports.h"
#include "hg/scenario/run/run_plan.h"

namespace hg::apps {

class Command;

struct MachineOptions {
  scenario::ScenarioOptions world{.scenario = "free_space"};
  scenario::MachineAddress machine;
  scenario::RunTiming timing;         ///< real time or lock-step, and the priority
  std::string folder = "recordings";  ///< folder for the result
};

/// Adds these options to a subcommand.
void add_machine_options(Command command, MachineOptions& options);

/// Text of an option that gives an address. `is_test`: only of devices that can be tested.
std::string address_help(bool is_test);

/// Throws SetupError if the device is reached by a transport that refuses `command`.
void refuse_command(const MachineOptions& options, const std::string& command,
                    std::string_view scenario::Transport::*refusal);

/// The scenario whose device it is. Creates the folder of the results. Throws SetupError.
config::Scenario make_machine_scenario(const MachineOptions& options);

struct Machine {
  std::unique_ptr<device::Device> device;
  device::ConnectedDevice* remote = nullptr;  ///< The same; null: simulated here
  bool is_simulated = true;
  std::string computer;  ///< What is bad about this computer and was let pass; empty: nothing
};

/// Connects to the machine for `command` ("start-test"); its machine.yaml becomes a source of
/// `scenario`. Throws SetupError.
Machine connect_machine(const MachineOptions& options, config::Scenario& scenario,
                        const std::string& command);

}  // namespace hg::apps

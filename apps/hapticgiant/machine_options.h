/// The machine, or its simulation, that a command without a twin talks to.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/device/connected_device.h"
#include "hg/scenario/options.h"

namespace hg::apps {

class Command;

struct MachineOptions {
  scenario::ScenarioOptions world{.scenario = "free_space"};
  /// HOST:PORT of a remote device, or ethercat://INTERFACE; empty = simulated here
  std::string device_address;
  std::string machine;   ///< machine.yaml of a bus; empty = the one beside the device file
  std::string key_file;  ///< file of the key shared with the device; empty = none
  bool is_fast = false;  ///< lock-step with a remote device
  int priority = 80;     ///< SCHED_FIFO priority, with a remote device in real time; 0 = ordinary
  /// Items of the doctor that may be bad on a computer that drives a machine
  std::vector<std::string> despite;
  std::string recordings = "recordings";  ///< folder for the result
};

/// Adds these options to a subcommand.
void add_machine_options(Command command, MachineOptions& options);

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

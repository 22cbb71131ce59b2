/// Connects to the device behind an address, with all that its transport and a real machine require
/// before it is driven: key, lock-step, start test, posture, a computer that is ready.
#pragma once

#include <memory>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/device/connected_device.h"
#include "hg/scenario/run/run_plan.h"
#include "hg/start_test/machine_memory.h"

namespace hg::scenario {

/// Where the data of a machine are stored. `folder` is that of the recordings.
start_test::MachineMemory machine_memory(const MachineAddress& machine, const std::string& folder);

struct Connection {
  std::unique_ptr<device::ConnectedDevice> device;
  bool is_simulated = false;
  bool is_machine = false;          ///< a real one that has a start test
  std::string note;                 ///< why no start test is required
  std::string start_test, posture;  ///< messages on those of a machine; see machine_memory.h
  /// What the doctor finds bad about this computer and --despite has let pass; empty = nothing
  std::string computer;
};

/// Connects for a run, which requires start test and posture of a machine, stored in `folder`. The
/// machine's own files become sources of `scenario`. A device that moves to the start by a motion
/// of its own does so. Throws SetupError.
Connection connect_to_run(const MachineAddress& machine, const RunTiming& timing,
                          const std::string& folder, config::Scenario& scenario);

/// Connects for `command` ("start-test"), which tests the device. Throws SetupError.
Connection connect_to_test(const MachineAddress& machine, const RunTiming& timing,
                           config::Scenario& scenario, const std::string& command);

/// Whether the run begins with a way by the law to the start; see move_to_start.h.
bool moves_by_law(const MachineAddress& machine);

/// Ends the session with a device. Returns its last message; empty = none.
std::string close_device(device::ConnectedDevice& device, FaultCode fault);

}  // namespace hg::scenario

/// All parts of a run, prepared before its clock starts.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/cycle.h"
#include "hg/device/connected_device.h"
#include "hg/page/run_page.h"
#include "hg/scenario/run/connection.h"
#include "hg/scenario/run/run_plan.h"

namespace hg::scenario {

/// Loads the scenario for a controller. With a remote device, simulation-only options are refused.
/// Throws SetupError.
config::Scenario load_to_run(const ScenarioOptions& world, const MachineAddress& machine);

struct PreparedRun {
  /// Loads the scenario, makes its cycle, and connects to its device. Throws SetupError.
  PreparedRun(const ScenarioOptions& world, const MachineAddress& machine, const RunTiming& timing,
              const RunRecords& records);
  /// The same with a scenario that was loaded, and changed, already.
  PreparedRun(config::Scenario loaded, const ScenarioOptions& world, const MachineAddress& machine,
              const RunTiming& timing, const RunRecords& records);

  PreparedRun(const PreparedRun&) = delete;
  PreparedRun& operator=(const PreparedRun&) = delete;

  /// The device at the other end of a connection; nullptr = simulated here
  device::ConnectedDevice* remote() const {
    return connection ? connection->device.get() : nullptr;
  }
  /// The same if it is a machine that has a start test; nullptr = it is none
  device::ConnectedDevice* machine() const {
    return connection && connection->is_machine ? connection->device.get() : nullptr;
  }
  device::Device& device() const { return connection ? *connection->device : *simulated; }

  /// The run for its page; valid while this exists. `fixed_by` says why pages change nothing about
  /// it; empty = they may.
  page::ShownRun shown(const std::string& fixed_by) const;

  const ScenarioOptions world;
  config::Scenario scenario;
  controller::Cycle cycle;
  std::optional<Connection> connection;         ///< to a remote device
  std::unique_ptr<device::Device> simulated;    ///< without one
  std::unique_ptr<TwinForceSource> twin_force;  ///< nullptr = none
  std::unique_ptr<TwinBaseSource> twin_base;    ///< nullptr = none
  std::string refusal;  ///< why the device neither waits nor starts again; empty = it does
};

}  // namespace hg::scenario

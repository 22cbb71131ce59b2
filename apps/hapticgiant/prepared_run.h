/// All parts of a run, prepared before its clock starts.
#pragma once

#include <memory>
#include <string>

#include "apps/hapticgiant/run_command.h"
#include "hg/config/simulation/scenario.h"
#include "hg/controller/cycle.h"
#include "hg/device/connected_device.h"
#include "hg/page/run_page.h"
#include "hg/scenario/start_posture.h"
#include "hg/start_test/machine_memory.h"

namespace hg::apps {

/// Where the data of the machine of a run are stored.
start_test::MachineMemory machine_memory(const RunArguments& arguments);

struct PreparedRun {
  /// Prepares a run. Throws SetupError.
  explicit PreparedRun(const RunArguments& arguments);
  /// The same with a scenario that was loaded, and changed, already.
  PreparedRun(const RunArguments& arguments, config::Scenario loaded);

  /// The run for its page; valid while this exists.
  page::ShownRun shown() const;

  const RunArguments arguments;
  config::Scenario scenario;
  controller::Cycle cycle;
  std::unique_ptr<device::Device> device;
  /// `device` as one at the other end of a connection; nullptr = simulated here
  device::ConnectedDevice* remote = nullptr;
  /// `device` as a real machine that has a start test; nullptr = it is none
  device::ConnectedDevice* machine = nullptr;
  std::string note;  ///< why a remote device needs no start test
  /// Messages on a machine's start test and posture; see machine_memory.h
  std::string start_test, posture;
  /// What the doctor finds bad about this computer and --despite has let pass; empty: nothing
  std::string computer;
  scenario::Start goal;  ///< where the way to the start of a run ends; see move_to_start.h
  std::string fixed_by;  ///< why pages change nothing about this run; empty = they may

 private:
  void connect_remote();
  void check_computer();
  void connect_franka();
  void connect_ethercat();
};

}  // namespace hg::apps

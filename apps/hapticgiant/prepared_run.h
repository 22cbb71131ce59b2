/// Everything that one run needs before its clock starts.
#pragma once

#include <memory>
#include <string>

#include "apps/hapticgiant/run_command.h"
#include "hg/config/scenario.h"
#include "hg/cycle/cycle.h"
#include "hg/device/device.h"
#include "hg/remote/remote_device.h"

namespace hg::apps {

struct PreparedRun {
  /// Throws SetupError.
  explicit PreparedRun(const RunArguments& arguments);

  const RunArguments arguments;
  const config::Scenario scenario;
  cycle::Cycle cycle;
  std::unique_ptr<device::Device> device;
  remote::RemoteDevice* remote = nullptr;  ///< the same; nullptr: it is simulated here
  bool is_machine = false;                 ///< nothing is simulated
  std::string start_test, posture;         ///< of a machine, in words; see device_memory.h
};

}  // namespace hg::apps

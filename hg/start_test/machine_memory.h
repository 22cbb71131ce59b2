/// Checks of a machine (a connected device that is no simulation) before a run, and stored data
/// about it: the result of its start test and its last posture.
#pragma once

#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/device/connected_device.h"
#include "hg/start_test/memory.h"

namespace hg::start_test {

/// Where the data of a machine are stored, and what its operator says about them.
struct MachineMemory {
  std::string folder;               ///< folder of the recordings
  std::string address;              ///< --device-address of the machine
  bool without_start_test = false;  ///< untested brakes are allowed
  /// Joints confirmed to have moved since the last run
  std::vector<std::string> confirmed_joints;
};

/// SHA-256 of the files that describe the device.
std::string sha256_of(const config::DeviceConfig& device);

/// File of the start test of the machine at `address` in the folder of the recordings; an empty
/// address stands for all simulations, whose results are never used for a machine.
std::string start_test_file(const std::string& folder, const config::DeviceConfig& device,
                            const std::string& address);

/// The same for the result of its first motions (`commission`).
std::string commission_file(const std::string& folder, const config::DeviceConfig& device,
                            const std::string& address);

/// Message on whether brakes and stop inputs were tested. Throws SetupError if they were not,
/// unless `memory` waives the test.
std::string check_start_test(const MachineMemory& memory, const config::DeviceConfig& device);

/// Compares the machine's posture with that at the end of the last run, with closed brakes. Returns
/// a message; throws SetupError if joints have moved that
/// `memory` does not confirm.
std::string check_posture(const MachineMemory& memory, const config::DeviceConfig& device,
                          device::ConnectedDevice& machine);

/// Stores the machine's posture at the end of its session, after a second with closed brakes. If a
/// brake slips meanwhile, or `fault` reports that one did, its start test becomes invalid. Returns
/// messages, one line each; empty if all is well.
std::vector<std::string> leave_machine(const MachineMemory& memory,
                                       const config::DeviceConfig& device,
                                       device::ConnectedDevice& machine, FaultCode fault);

}  // namespace hg::start_test

/// The slaves of an EtherCAT bus: who they are, in which state, and whether all take part.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hg/device/ethercat/master.h"

namespace hg::ethercat {

/// Takes all slaves behind a network interface to PRE-OP and returns them in the order of the
/// cable. Drives in operation lose their commands by this. Throws SetupError.
std::vector<BusSlave> scan_bus(const std::string& interface_name);

/// How a bus is watched.
struct BusWatchOptions {
  double seconds = 10.0;            ///< duration
  std::uint32_t watchdog_ms = 100;  ///< of slaves with outputs, 1 to 6553
};

/// What was seen of the exchanges.
struct BusWatchResult {
  std::uint64_t exchanges = 0;
  std::uint64_t lost = 0;        ///< without an answer
  std::uint64_t incomplete = 0;  ///< with a working counter that is not the expected one
};

/// Takes all slaves to OP with outputs of zero, so that drives stay off, and exchanges process data
/// at 1 kHz until the time is over or `interrupted`. Each change of what is wrong is given to
/// `report`, with the time in s and the slaves that have left OP, and before it the slaves whose
/// watchdog is switched off. Throws SetupError.
BusWatchResult watch_bus(const std::string& interface_name, const BusWatchOptions& options,
                         const std::atomic<bool>& interrupted,
                         const std::function<void(double, const std::string&)>& report);

}  // namespace hg::ethercat

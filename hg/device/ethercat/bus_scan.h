/// The slaves of an EtherCAT bus: who they are, in which state, and whether all take part.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hg::ethercat {

/// One slave as it was found.
struct BusSlave {
  std::string name;        ///< of its type, from its EEPROM
  std::uint32_t vendor;    ///< identity, from its EEPROM
  std::uint32_t product;   ///< of this vendor
  std::uint32_t revision;  ///< of this product
  std::uint32_t serial;    ///< 0: the vendor gives none
  std::uint16_t address;   ///< that the scan has given to it
  bool has_clock;          ///< distributed clock
  std::uint32_t delay_ns;  ///< time that a frame takes from the first clock to it
  std::uint8_t status;     ///< AL status: state and, 0x10, error flag
};

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
/// `report`, with the time in s and the slaves that have left OP. Throws SetupError.
BusWatchResult watch_bus(const std::string& interface_name, const BusWatchOptions& options,
                         const std::atomic<bool>& interrupted,
                         const std::function<void(double, const std::string&)>& report);

/// Name of the state in an AL status, with "+ error" where its error flag is set.
std::string state_name(std::uint8_t status);

}  // namespace hg::ethercat

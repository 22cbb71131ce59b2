/// The slaves of an EtherCAT bus: who they are and in which state.
#pragma once

#include <cstdint>
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

/// Name of the state in an AL status, with "+ error" where its error flag is set.
std::string state_name(std::uint8_t status);

}  // namespace hg::ethercat

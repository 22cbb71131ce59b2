/// Compares the slaves of a bus with the file of the machine.
#pragma once

#include <string>
#include <vector>

#include "hg/device/ethercat/machine.h"
#include "hg/device/ethercat/master.h"

namespace hg::ethercat {

/// Name of a slave in messages: "slave 3 (m1)".
std::string slave_name(const Machine& machine, std::size_t slave);

/// Writes the settings and watchdogs of the file to the slaves of the last scan, reads them back,
/// and compares identity, modes and process data. Returns one sentence for each difference; none:
/// the bus is the machine. Throws SetupError.
std::vector<std::string> differences(Master& master, const std::vector<BusSlave>& found,
                                     const Machine& machine);

}  // namespace hg::ethercat

/// Compares the slaves of a bus with the file of the machine.
#pragma once

#include <string>
#include <vector>

#include "hg/device/ethercat/bus.h"
#include "hg/device/ethercat/machine.h"

namespace hg::ethercat {

/// Name of a slave in messages: "slave 3 (m1)".
std::string slave_name(const Machine& machine, std::size_t slave);

/// Writes the settings and watchdogs of the file to the slaves of the last scan, reads them back,
/// and compares identity, modes, what drives do when they are stopped, and process data. Returns
/// one sentence for each difference; none: the bus is the machine. Throws SetupError.
std::vector<std::string> differences(Bus& bus, const std::vector<BusSlave>& found,
                                     const Machine& machine);

/// What each drive of a bus without differences does when it is stopped, by its option codes, one
/// sentence each. Throws SetupError.
std::vector<std::string> stop_words(Bus& bus, const Machine& machine);

}  // namespace hg::ethercat

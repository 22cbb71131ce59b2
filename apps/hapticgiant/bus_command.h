/// Looks at the slaves of an EtherCAT bus.
#pragma once

#include <string>

#include "hg/device/ethercat/bus_scan.h"

namespace hg::apps {

class Command;

/// Takes all slaves behind a network interface to PRE-OP and prints what they are. Throws
/// SetupError.
void bus_scan(const std::string& interface_name);

/// Exchanges process data and prints what goes wrong. Exit code: 0 nothing, 1 an exchange was lost
/// or incomplete. Throws SetupError.
int bus_watch(const std::string& interface_name, const ethercat::BusWatchOptions& options);

/// Compares all slaves with the file of a machine and prints one sentence for each difference. Exit
/// code: 0 none, 1 some. Throws SetupError.
int bus_check(const std::string& interface_name, const std::string& file);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_bus(Command app, int& exit_code);

}  // namespace hg::apps

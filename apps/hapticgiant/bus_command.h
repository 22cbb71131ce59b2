/// Looks at the slaves of an EtherCAT bus.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace hg::apps {

/// Takes all slaves behind a network interface to PRE-OP and prints what they are. Throws
/// SetupError.
void bus_scan(const std::string& interface_name);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_bus(CLI::App& app, int& exit_code);

}  // namespace hg::apps

#include "apps/hapticgiant/bus_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstddef>
#include <memory>
#include <vector>

#include "apps/hapticgiant/output.h"
#include "hg/device/ethercat/bus_scan.h"

namespace hg::apps {
namespace {

void print(std::size_t position, const ethercat::BusSlave& slave) {
  const std::string clock =
      slave.has_clock ? fmt::format("{} ns", slave.delay_ns) : std::string("-");
  print_out(fmt::format("{:3}  {:#06x}   {:#010x}  {:#010x}  {:8}  {:8}  {:>9}  {:6}  {}\n",
                        position, slave.address, slave.vendor, slave.product, slave.revision,
                        slave.serial, clock, ethercat::state_name(slave.status), slave.name));
}

}  // namespace

void bus_scan(const std::string& interface_name) {
  const std::vector<ethercat::BusSlave> slaves = ethercat::scan_bus(interface_name);
  print_out(fmt::format("{} slaves on {}\n\n", slaves.size(), interface_name));
  print_out("     address  vendor      product     revision    serial      delay  state   name\n");
  for (std::size_t i = 0; i < slaves.size(); ++i) print(i + 1, slaves[i]);
}

void add_bus(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("bus", "Looks at the slaves of an EtherCAT bus.");
  command->require_subcommand(1);
  const auto interface_name = std::make_shared<std::string>();
  CLI::App* scan = command->add_subcommand(
      "scan", "Lists the slaves behind a network interface: identity, clock, state.");
  scan->footer(
      "Takes all slaves to PRE-OP: drives in operation lose their commands. Needs raw sockets, as "
      "root or with the capability cap_net_raw.\n"
      "Example:\n"
      "  hapticgiant bus scan eth1");
  scan->add_option("INTERFACE", *interface_name, "network interface with the first slave")
      ->required();
  scan->callback([interface_name, &exit_code] {
    bus_scan(*interface_name);
    exit_code = 0;
  });
}

}  // namespace hg::apps

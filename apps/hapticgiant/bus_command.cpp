#include "apps/hapticgiant/bus_command.h"

#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "hg/config/bus/machine_file.h"
#include "hg/device/ethercat/bus_check.h"

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

int bus_watch(const std::string& interface_name, const ethercat::BusWatchOptions& options) {
  const ethercat::BusWatchResult result = ethercat::watch_bus(
      interface_name, options, watch_interruption(), [](double time_s, const std::string& words) {
        print_out(fmt::format("{:9.3f} s  {}\n", time_s, words));
      });
  print_out(fmt::format("{} exchanges, {} without an answer, {} incomplete\n", result.exchanges,
                        result.lost, result.incomplete));
  return result.lost + result.incomplete > 0 ? 1 : 0;
}

int bus_check(const std::string& interface_name, const std::string& file) {
  config::SourceReader reader;
  const ethercat::Machine machine = config::load_machine(file, reader, {});
  ethercat::Master master(interface_name);
  const std::vector<ethercat::BusSlave> found = master.scan();
  const std::vector<std::string> sentences = ethercat::differences(master, found, machine);
  for (const std::string& sentence : sentences) print_out(sentence + "\n");
  if (!sentences.empty()) return 1;
  print_out(fmt::format("{} slaves on {} are those of {}, settings and watchdogs read back\n",
                        found.size(), interface_name, file));
  for (const std::string& words : ethercat::stop_words(master, machine)) print_out(words + "\n");
  return 0;
}

namespace {

void add_check(Command bus, int& exit_code) {
  struct Arguments {
    std::string file, interface_name;
  };
  const auto arguments = std::make_shared<Arguments>();
  const Command check = bus.add_subcommand(
      "check", "Compares every slave with the file of the machine: identity, objects, watchdog.");
  check.footer(
      "Takes all slaves to PRE-OP and writes the settings of the file to them. Exit code 1: "
      "something is different.\n"
      "Example:\n"
      "  hapticgiant bus check machine.yaml eth1");
  check.add_option("MACHINE", arguments->file, "machine.yaml").required();
  check.add_option("INTERFACE", arguments->interface_name, "as in scan").required();
  check.callback([arguments, &exit_code] {
    exit_code = bus_check(arguments->interface_name, arguments->file);
  });
}

void add_watch(Command bus, int& exit_code) {
  struct Arguments {
    std::string interface_name;
    ethercat::BusWatchOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  const Command watch = bus.add_subcommand(
      "watch", "Exchanges process data at 1 kHz, and names the slaves that drop out.");
  watch.footer(
      "All outputs are zero: drives stay off. Ctrl-C ends it. Exit code 1: an exchange was lost or "
      "incomplete.\n"
      "Example:\n"
      "  hapticgiant bus watch eth1 --seconds 600");
  watch.add_option("INTERFACE", arguments->interface_name, "as in scan").required();
  watch.add_option("--seconds", arguments->options.seconds, "duration")
      .check(number_that("from 0.1 to 1000000", [](double v) { return v >= 0.1 && v <= 1e6; }))
      .capture_default_str();
  watch
      .add_option("--watchdog-ms", arguments->options.watchdog_ms,
                  "time after which a slave without outputs leaves OP")
      .check(whole_number(1, 6553))
      .capture_default_str();
  watch.callback([arguments, &exit_code] {
    exit_code = bus_watch(arguments->interface_name, arguments->options);
  });
}

}  // namespace

void add_bus(Command app, int& exit_code) {
  const Command command = app.add_subcommand("bus", "Looks at the slaves of an EtherCAT bus.");
  command.require_subcommand(1);
  const auto interface_name = std::make_shared<std::string>();
  const Command scan = command.add_subcommand(
      "scan", "Lists the slaves behind a network interface: identity, clock, state.");
  scan.footer(
      "Takes all slaves to PRE-OP: drives in operation lose their commands. Needs raw sockets, as "
      "root or with the capability cap_net_raw.\n"
      "Example:\n"
      "  hapticgiant bus scan eth1");
  scan.add_option("INTERFACE", *interface_name, "network interface with the first slave")
      .required();
  scan.callback([interface_name, &exit_code] {
    bus_scan(*interface_name);
    exit_code = 0;
  });
  add_check(command, exit_code);
  add_watch(command, exit_code);
}

}  // namespace hg::apps

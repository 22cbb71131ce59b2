#include "hg/device/ethercat/bus_scan.h"

#include <fmt/format.h>

#include <cstddef>
#include <memory>

#include "hg/core/error.h"
#include "hg/device/ethercat/bus_master/bus_master.h"

namespace hg::ethercat {
namespace {

constexpr std::uint8_t kErrorFlag = 0x10;

BusSlave slave_of(const bus_slave& found) {
  return {.name = found.name,
          .vendor = found.vendor,
          .product = found.product,
          .revision = found.revision,
          .serial = found.serial,
          .address = found.address,
          .has_clock = found.has_clock,
          .delay_ns = found.delay_ns,
          .status = found.status};
}

}  // namespace

std::vector<BusSlave> scan_bus(const std::string& interface_name) {
  const std::unique_ptr<bus_master, decltype(&bus_master_free)> master(
      bus_master_open(interface_name.c_str()), &bus_master_free);
  const std::size_t count = bus_master_scan(master.get());
  if (const std::string error = bus_master_error(master.get()); !error.empty()) {
    throw SetupError(error);
  }
  std::vector<BusSlave> slaves;
  bus_slave found;
  for (std::size_t i = 0; i < count && bus_master_slave(master.get(), i, &found); ++i) {
    slaves.push_back(slave_of(found));
  }
  return slaves;
}

std::string state_name(std::uint8_t status) {
  const auto name = [&]() -> std::string {
    switch (status & 0x0F) {
      case 1:
        return "INIT";
      case 2:
        return "PRE-OP";
      case 3:
        return "BOOT";
      case 4:
        return "SAFE-OP";
      case 8:
        return "OP";
      default:
        return fmt::format("state {}", status & 0x0F);
    }
  }();
  return (status & kErrorFlag) != 0 ? name + " + error" : name;
}

}  // namespace hg::ethercat

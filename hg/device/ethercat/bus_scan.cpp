#include "hg/device/ethercat/bus_scan.h"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <thread>

#include "hg/core/error.h"
#include "hg/device/ethercat/bus_master/bus_master.h"

namespace hg::ethercat {
namespace {

constexpr std::uint8_t kErrorFlag = 0x10;
constexpr std::uint8_t kOp = 0x08;
constexpr std::chrono::milliseconds kPeriod{1};
constexpr std::uint32_t kPatience_us = 20'000;  // of a computer that is not real-time

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

// The master of the Rust library; the first error of a call becomes an exception.
class Master {
 public:
  explicit Master(const std::string& interface_name)
      : master_(bus_master_open(interface_name.c_str()), &bus_master_free) {
    check();
  }

  std::vector<BusSlave> scan() {
    const std::size_t count = bus_master_scan(master_.get());
    check();
    std::vector<BusSlave> slaves;
    bus_slave found;
    for (std::size_t i = 0; i < count && bus_master_slave(master_.get(), i, &found); ++i) {
      slaves.push_back(slave_of(found));
    }
    return slaves;
  }

  /// The working counter of an exchange in which all slaves take part.
  int start(std::uint32_t watchdog_ms) {
    const int expected = bus_master_start(master_.get(), watchdog_ms);
    check();
    return expected;
  }

  int exchange(std::uint32_t patience_us) {
    return bus_master_exchange(master_.get(), patience_us);
  }

  /// What is wrong with a slave; empty: it is in OP.
  std::string fault_of(std::size_t index) {
    std::uint8_t status = 0;
    std::uint16_t code = 0;
    if (!bus_master_status(master_.get(), index, &status, &code)) return "does not answer";
    if (status == kOp) return "";
    return fmt::format("{}, AL status code {:#06x}", state_name(status), code);
  }

 private:
  void check() const {
    if (const std::string error = bus_master_error(master_.get()); !error.empty()) {
      throw SetupError(error);
    }
  }

  std::unique_ptr<bus_master, decltype(&bus_master_free)> master_;
};

// which slaves have left OP
std::string faults_of(Master& master, const std::vector<BusSlave>& slaves) {
  std::string faults;
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    if (const std::string fault = master.fault_of(i); !fault.empty()) {
      faults += fmt::format("; slave {} ({:#06x}, {}): {}", i + 1, slaves[i].address,
                            slaves[i].name, fault);
    }
  }
  return faults;
}

}  // namespace

std::vector<BusSlave> scan_bus(const std::string& interface_name) {
  return Master(interface_name).scan();
}

BusWatchResult watch_bus(const std::string& interface_name, const BusWatchOptions& options,
                         const std::atomic<bool>& interrupted,
                         const std::function<void(double, const std::string&)>& report) {
  Master master(interface_name);
  const std::vector<BusSlave> slaves = master.scan();
  const int expected = master.start(options.watchdog_ms);
  report(0.0, fmt::format("{} slaves in OP, working counter {}", slaves.size(), expected));

  BusWatchResult result;
  const auto began = std::chrono::steady_clock::now();
  int before = expected;
  for (auto next = began; !interrupted; next += kPeriod) {
    std::this_thread::sleep_until(next);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - began;
    if (time.count() >= options.seconds) break;
    const int counter = master.exchange(kPatience_us);
    ++result.exchanges;
    result.lost += counter < 0 ? 1 : 0;
    result.incomplete += counter >= 0 && counter != expected ? 1 : 0;
    if (counter == before) continue;
    before = counter;
    report(time.count(), counter < 0 ? "no answer"
                                     : fmt::format("working counter {} of {}{}", counter, expected,
                                                   faults_of(master, slaves)));
  }
  return result;
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

#include "hg/device/ethercat/bus_scan.h"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <thread>

#include "hg/device/ethercat/bus_registers.h"

namespace hg::ethercat {
namespace {

constexpr std::chrono::milliseconds kPeriod{1};
constexpr std::uint32_t kPatience_us = 20'000;  // of a computer that is not real-time

// What is wrong with a slave; empty: it is in OP.
std::string fault_of(Master& master, std::size_t index) {
  const auto found = master.status(index, kPatience_us);
  if (!found) return "does not answer";
  if (found->status == kOp) return "";
  return fmt::format("{}, AL status code {}", state_name(found->status),
                     status_code_words(found->code));
}

// which slaves have left OP
std::string faults_of(Master& master, const std::vector<BusSlave>& slaves) {
  std::string faults;
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    if (const std::string fault = fault_of(master, i); !fault.empty()) {
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
  const int expected = master.start(options.watchdog_ms, 0);
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    if (master.sizes(i).outputs == 0) continue;
    if (const std::string fault = watchdog_fault(master, i); !fault.empty()) {
      report(0.0, fmt::format("slave {} ({:#06x}, {}): {}", i + 1, slaves[i].address,
                              slaves[i].name, fault));
    }
  }
  master.operate(slaves.size(), [] { std::this_thread::sleep_for(kPeriod); });
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

}  // namespace hg::ethercat

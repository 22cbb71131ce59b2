#include "hg/device/ethercat/bus_registers.h"

#include <fmt/format.h>

#include <algorithm>

#include "hg/device/ethercat/bus_check.h"

namespace hg::ethercat {
namespace {

constexpr std::uint16_t kSyncManagerCount = 0x0005;
constexpr std::uint16_t kSyncManagers = 0x0800;
constexpr std::uint16_t kSyncManagerBytes = 8;
constexpr std::uint16_t kControl = 4;  // of a sync manager, followed by status and activation
constexpr std::uint32_t kMostSyncManagers = 16;
constexpr std::uint32_t kActive = 0x0001'0000;       // in four bytes from control on
constexpr std::uint32_t kMode = 0x0F;                // buffered or mailbox, and direction
constexpr std::uint32_t kBufferedOutputs = 0x04;     // process data that a master writes
constexpr std::uint32_t kWatchdogTrigger = 0x40;     // outputs restart the watchdog, if it is on
constexpr std::uint16_t kTimeDifference = 0x092C;    // sign and magnitude, ns
constexpr std::uint16_t kPulseActivation = 0x0981;   // 1: cyclic, 2: SYNC0
constexpr std::uint16_t kActivationStatus = 0x0984;  // 1: first pulse is still to come, 4: too far
constexpr std::uint16_t kNextPulse = 0x0990;
constexpr std::uint32_t kPulsesOn = 0x03;
constexpr std::uint32_t kPulsesWrong = 0x05;

const char* const kNoAnswer = "does not answer when its registers are read";

}  // namespace

std::string watchdog_fault(Bus& bus, std::size_t slave) {
  const auto count = bus.read_register(slave, kSyncManagerCount, 1);
  if (!count) return kNoAnswer;
  bool has_outputs = false;
  for (std::uint32_t i = 0; i < std::min(*count, kMostSyncManagers); ++i) {
    const auto address = static_cast<std::uint16_t>(kSyncManagers + kSyncManagerBytes * i);
    const auto found = bus.read_register(slave, address + kControl, 4);
    if (!found) return kNoAnswer;
    if ((*found & kActive) == 0 || (*found & kMode) != kBufferedOutputs) continue;
    has_outputs = true;
    if ((*found & kWatchdogTrigger) != 0) continue;
    return fmt::format(
        "its watchdog is switched off (bit 6 of the control byte {:#04x} of sync manager {}): "
        "without frames it would go on with its last outputs",
        *found & 0xFFU, i);
  }
  return has_outputs ? "" : "none of its sync managers has its outputs, and so a watchdog";
}

std::vector<std::string> watchdog_faults(Bus& bus, const Machine& machine) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < machine.slaves.size(); ++i) {
    if (machine.slaves[i].outputs.empty()) continue;
    const std::string fault = watchdog_fault(bus, i);
    if (!fault.empty()) result.push_back(slave_name(machine, i) + ": " + fault);
  }
  return result;
}

PulseCheck::PulseCheck(Bus& bus, const Machine& machine, std::uint32_t most_ns)
    : bus_(bus), machine_(machine), most_ns_(most_ns), last_(machine.slaves.size()) {}

std::vector<std::string> PulseCheck::faults() {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < machine_.slaves.size(); ++i) {
    if (!machine_.slaves[i].is_synchronous) continue;
    const std::string fault = fault_of(i);
    if (!fault.empty()) result.push_back(slave_name(machine_, i) + ": " + fault);
  }
  return result;
}

std::string PulseCheck::fault_of(std::size_t slave) {
  const auto activation = bus_.read_register(slave, kPulseActivation, 1);
  const auto status = bus_.read_register(slave, kActivationStatus, 1);
  const auto next = bus_.read_register(slave, kNextPulse, 4);
  const auto difference = bus_.read_register(slave, kTimeDifference, 4);
  if (!activation || !status || !next || !difference) return kNoAnswer;
  const bool has_gone_on = last_[slave] && *last_[slave] != *next;
  last_[slave] = next;
  if ((*activation & kPulsesOn) != kPulsesOn) {
    return fmt::format("its sync pulses are off (register 0x0981 is {:#04x})", *activation);
  }
  if ((*status & kPulsesWrong) != 0) {
    return fmt::format("its first sync pulse does not come (register 0x0984 is {:#04x})", *status);
  }
  if (!has_gone_on) return "its sync pulses do not come (register 0x0990 stands)";
  const std::uint32_t away_ns = *difference & 0x7FFF'FFFFU;
  if (away_ns <= most_ns_) return "";
  return fmt::format("its clock is {} ns from the first one (register 0x092C), at most are {} ns",
                     away_ns, most_ns_);
}

}  // namespace hg::ethercat

/// What the controllers of slaves say in their registers, after settings were written to them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/device/ethercat/bus.h"
#include "hg/device/ethercat/machine.h"

namespace hg::ethercat {

/// What is wrong with the watchdog of a slave with outputs: it is switched off, or the slave does
/// not say so; empty: nothing. From SAFE-OP on.
std::string watchdog_fault(Bus& bus, std::size_t slave);

/// The same of all slaves of a machine: one sentence for each slave with outputs whose watchdog is
/// switched off, or that does not say so. From SAFE-OP on.
std::vector<std::string> watchdog_faults(Bus& bus, const Machine& machine);

/// Looks at the sync pulses of the slaves that use them.
class PulseCheck {
 public:
  /// `most_ns`: how far the clock of a slave may be from the first one.
  PulseCheck(Bus& bus, const Machine& machine, std::uint32_t most_ns);

  /// One sentence for each slave whose pulses are off, or have not gone on since the last call, or
  /// whose clock is too far from the first one; the first call has none to compare with. Exchanges
  /// must come before each call: they hold the clocks together.
  std::vector<std::string> faults();

 private:
  std::string fault_of(std::size_t slave);

  Bus& bus_;
  const Machine& machine_;
  std::uint32_t most_ns_;
  std::vector<std::optional<std::uint32_t>> last_;  ///< by slave: its next pulse at the last call
};

}  // namespace hg::ethercat

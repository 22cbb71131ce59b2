/// The EtherCAT master of the Rust library, in C++.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hg/device/ethercat/bus.h"

struct bus_master;

namespace hg::ethercat {

class Master final : public Bus {
 public:
  /// Opens a network interface. Throws SetupError.
  explicit Master(const std::string& interface_name);

  std::vector<BusSlave> scan() override;
  ObjectResult read(std::size_t slave, ObjectKey object, std::size_t bytes) override;
  ObjectResult write(std::size_t slave, ObjectKey object, std::size_t bytes,
                     std::uint32_t value) override;
  std::optional<std::uint32_t> read_register(std::size_t slave, std::uint16_t address,
                                             std::size_t bytes) override;
  bool set_watchdog(std::size_t slave, std::uint32_t watchdog_ms) override;
  void use_sync(std::size_t slave) override;
  int start(std::uint32_t watchdog_ms, std::uint32_t sync_ns) override;
  void operate(std::size_t slaves, const std::function<void()>& wait_for_turn) override;
  Sizes sizes(std::size_t slave) override;
  void set_outputs(std::size_t slave, std::span<const std::uint8_t> data) noexcept override;
  void get_inputs(std::size_t slave, std::span<std::uint8_t> data) const noexcept override;
  int exchange(std::uint32_t patience_us) noexcept override;
  std::uint64_t time_ns() const noexcept override;
  std::uint8_t state(std::size_t slave) const noexcept override;
  bool request_state(std::size_t slave, std::uint8_t state,
                     std::uint32_t patience_us) noexcept override;
  std::optional<SlaveStatus> status(std::size_t slave, std::uint32_t patience_us) noexcept override;

 private:
  void check() const;

  std::unique_ptr<bus_master, void (*)(bus_master*)> master_;
};

/// Name of the state in an AL status, with "+ error" where its error flag is set.
std::string state_name(std::uint8_t status);

/// An AL status code with its meaning: "0x001b: Sync Manager Watchdog".
std::string status_code_words(std::uint16_t code);

/// What came of an access that failed: "does not answer", or the abort code with its meaning.
std::string abort_words(std::int64_t abort);

}  // namespace hg::ethercat

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

struct bus_master;

namespace hg::ethercat {

/// One slave as it was found.
struct BusSlave {
  std::string name;        ///< of its type, from its EEPROM
  std::uint32_t vendor;    ///< identity, from its EEPROM
  std::uint32_t product;   ///< of this vendor
  std::uint32_t revision;  ///< of this product
  std::uint32_t serial;    ///< 0: the vendor gives none
  std::uint16_t address;   ///< that the scan has given to it
  bool has_clock;          ///< distributed clock
  std::uint32_t delay_ns;  ///< time that a frame takes from the first clock to it
  std::uint8_t status;     ///< AL status: state and, 0x10, error flag
};

/// Object of a slave.
struct ObjectKey {
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
};

/// What came of an access to an object.
struct ObjectResult {
  std::uint32_t value = 0;  ///< as read
  std::int64_t abort = 0;   ///< 0: done; more: abort code of the slave; -1: no answer
};

/// AL status of a slave.
struct SlaveStatus {
  std::uint8_t status = 0;  ///< state and, 0x10, error flag
  std::uint16_t code = 0;   ///< AL status code
};

inline constexpr std::uint8_t kPreOp = 0x02;
inline constexpr std::uint8_t kSafeOp = 0x04;
inline constexpr std::uint8_t kOp = 0x08;
inline constexpr std::uint8_t kErrorFlag = 0x10;

class Master {
 public:
  /// Opens a network interface. Throws SetupError.
  explicit Master(const std::string& interface_name);

  // Set-up: these throw SetupError.

  /// Takes all slaves to PRE-OP and returns them in the order of the cable.
  std::vector<BusSlave> scan();
  /// Reads an object of `bytes` 1, 2 or 4 of a slave in PRE-OP.
  ObjectResult read(std::size_t slave, ObjectKey object, std::size_t bytes);
  /// Writes one.
  ObjectResult write(std::size_t slave, ObjectKey object, std::size_t bytes, std::uint32_t value);
  /// Sets the watchdog of process data and reads it back; false: it is another one.
  bool set_watchdog(std::size_t slave, std::uint32_t watchdog_ms);
  /// This slave gets sync pulses from the next start() on.
  void use_sync(std::size_t slave);
  /// Takes all slaves to SAFE-OP with outputs of zero. Returns the working counter of an exchange
  /// in which all of them take part.
  int start(std::uint32_t watchdog_ms, std::uint32_t sync_ns);
  /// Takes all slaves to OP: exchanges each time that `wait_for_turn` has returned.
  void operate(std::size_t slaves, const std::function<void()>& wait_for_turn);
  /// Bytes of outputs and inputs of a slave, after start().
  struct Sizes {
    std::size_t outputs = 0, inputs = 0;
  };
  Sizes sizes(std::size_t slave);

  // In operation: no allocation, noexcept.

  void set_outputs(std::size_t slave, std::span<const std::uint8_t> data) noexcept;
  void get_inputs(std::size_t slave, std::span<std::uint8_t> data) const noexcept;
  /// The working counter; -1: no answer within this time.
  int exchange(std::uint32_t patience_us) noexcept;
  /// Time of the first clock when the last exchange passed it; 0: there is no clock. Sync pulses
  /// come at its whole periods.
  std::uint64_t time_ns() const noexcept;
  /// AL state of a slave by the last exchange; 0: it did not answer.
  std::uint8_t state(std::size_t slave) const noexcept;
  bool request_state(std::size_t slave, std::uint8_t state, std::uint32_t patience_us) noexcept;
  /// AL status and code; nothing: no answer in time.
  std::optional<SlaveStatus> status(std::size_t slave, std::uint32_t patience_us) noexcept;

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

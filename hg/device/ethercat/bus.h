/// A bus of slaves as EthercatDevice uses it: Master on a network interface, or one of a test.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

class Bus {
 public:
  virtual ~Bus() = default;

  // Set-up: these throw SetupError.

  /// Takes all slaves to PRE-OP and returns them in the order of the cable.
  virtual std::vector<BusSlave> scan() = 0;
  /// Reads an object of `bytes` 1, 2 or 4 of a slave in PRE-OP.
  virtual ObjectResult read(std::size_t slave, ObjectKey object, std::size_t bytes) = 0;
  /// Writes one.
  virtual ObjectResult write(std::size_t slave, ObjectKey object, std::size_t bytes,
                             std::uint32_t value) = 0;
  /// Reads a register of `bytes` 1, 2 or 4 of the controller of a slave, in any state; nothing: no
  /// answer.
  virtual std::optional<std::uint32_t> read_register(std::size_t slave, std::uint16_t address,
                                                     std::size_t bytes) = 0;
  /// Sets the watchdog of process data and reads it back; false: it is another one.
  virtual bool set_watchdog(std::size_t slave, std::uint32_t watchdog_ms) = 0;
  /// This slave gets sync pulses from the next start() on.
  virtual void use_sync(std::size_t slave) = 0;
  /// Takes all slaves to SAFE-OP with outputs of zero. Returns the working counter of an exchange
  /// in which all of them take part.
  virtual int start(std::uint32_t watchdog_ms, std::uint32_t sync_ns) = 0;
  /// Takes all slaves to OP: exchanges each time that `wait_for_turn` has returned.
  virtual void operate(std::size_t slaves, const std::function<void()>& wait_for_turn) = 0;
  /// Bytes of outputs and inputs of a slave, after start().
  struct Sizes {
    std::size_t outputs = 0, inputs = 0;
  };
  virtual Sizes sizes(std::size_t slave) = 0;

  // In operation: no allocation, noexcept.

  virtual void set_outputs(std::size_t slave, std::span<const std::uint8_t> data) noexcept = 0;
  virtual void get_inputs(std::size_t slave, std::span<std::uint8_t> data) const noexcept = 0;
  /// The working counter; -1: no answer within this time.
  virtual int exchange(std::uint32_t patience_us) noexcept = 0;
  /// Time of the first clock when the last exchange passed it; 0: there is no clock. Sync pulses
  /// come at its whole periods.
  virtual std::uint64_t time_ns() const noexcept = 0;
  /// AL state of a slave by the last exchange; 0: it did not answer.
  virtual std::uint8_t state(std::size_t slave) const noexcept = 0;
  virtual bool request_state(std::size_t slave, std::uint8_t state,
                             std::uint32_t patience_us) noexcept = 0;
  /// AL status and code; nothing: no answer in time.
  virtual std::optional<SlaveStatus> status(std::size_t slave,
                                            std::uint32_t patience_us) noexcept = 0;
};

}  // namespace hg::ethercat

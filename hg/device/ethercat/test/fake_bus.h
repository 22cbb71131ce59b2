/// A bus without frames for tests of EthercatDevice: two drives and a panel, which a test breaks.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hg/device/ethercat/bits.h"
#include "hg/device/ethercat/bus.h"
#include "hg/device/ethercat/drive_state.h"
#include "hg/device/ethercat/machine.h"

namespace hg::ethercat {

inline constexpr std::size_t kDrives = 2, kPanel = 2, kFakeSlaves = 3;
inline constexpr std::int64_t kPeriod_ns = 1'000'000;

/// Two joints led by torques, one unit per Nm, and a panel with brakes and an emergency stop.
inline Machine fake_machine() {
  Machine machine{.name = "bench", .watchdog_s = 6.0, .answer_s = 1e-3};
  for (int i = 0; i < static_cast<int>(kDrives); ++i) {
    machine.slaves.push_back(
        {.name = "m" + std::to_string(i + 1),
         .vendor = 1,
         .product = 2,
         .revision = 3,
         .joint = i,
         .mode = DriveMode::kCst,
         .outputs = {{.object = 0x6040, .bits = 16, .meaning = Output::kControlWord},
                     {.object = 0x6071, .bits = 16, .meaning = Output::kTargetTorque}},
         .inputs = {{.object = 0x6041, .bits = 16, .meaning = Input::kStatusWord},
                    {.object = 0x6064, .bits = 32, .meaning = Input::kLinkPosition}}});
  }
  machine.slaves.push_back(
      {.name = "panel",
       .vendor = 1,
       .product = 4,
       .revision = 3,
       .outputs = {{.object = 0x7100, .bits = 1, .meaning = Output::kOpenBrakes},
                   {.object = 0x7101, .bits = 1, .meaning = Output::kReset},
                   {.bits = 6}},
       .inputs = {{.object = 0x6100, .bits = 1, .meaning = Input::kEmergencyStop}, {.bits = 7}}});
  return machine;
}

/// A drive: the states of CiA 402, and what may be wrong with it.
class FakeDrive {
 public:
  bool stays_broken = false;  ///< a reset does not help
  bool ignores = false;       ///< is enabled and does not follow (bit 12)
  std::uint16_t control = 0, last_control = 0;
  std::int32_t target = 0;

  void fail() { status_ = 0x0218; }
  std::uint16_t status() const {
    return state() == DriveState::kOperationEnabled && !ignores ? status_ | 0x1000 : status_;
  }
  DriveState state() const { return state_of(status_); }

  void obey(std::span<const std::uint8_t> outputs) {
    last_control = std::exchange(control, static_cast<std::uint16_t>(read_bits(outputs, 0, 16)));
    target = signed_of(read_bits(outputs, 16, 16), 16);
    status_ = next();
  }

 private:
  std::uint16_t next() const {
    const bool is_reset = (control & 0x80) != 0 && (last_control & 0x80) == 0;
    if (state() == DriveState::kFault) return is_reset && !stays_broken ? 0x0250 : status_;
    const bool is_on = state() == DriveState::kOperationEnabled;
    if ((control & 0x02) == 0 || state() == DriveState::kQuickStopActive) return 0x0250;
    if ((control & 0x06) == 0x02) return is_on ? 0x0217 : 0x0250;
    if ((control & 0x07) == 0x06) return 0x0231;
    if (state() == DriveState::kSwitchOnDisabled) return 0x0250;
    if (state() == DriveState::kReadyToSwitchOn) return 0x0233;
    return (control & 0x08) != 0 ? 0x0237 : 0x0233;
  }

  std::uint16_t status_ = 0x0250;
};

/// What a test sees of the bus, and breaks.
struct FakeSegment {
  Machine machine = fake_machine();
  FakeDrive drives[kDrives];
  std::uint8_t states[kFakeSlaves] = {kPreOp, kPreOp, kPreOp};
  bool answers = true;                                  ///< frames come back
  int missing = 0;                                      ///< of the working counter
  int exchanges = 0;                                    ///< that slaves have seen
  std::int64_t phase_ns = kPeriod_ns / 2;               ///< of frames between two sync pulses
  bool opens_brakes = false;                            ///< last outputs of the panel
  bool has_reset = false;                               ///< likewise
  std::map<std::uint16_t, std::int16_t> options;        ///< objects of the drives
  std::map<std::uint16_t, std::uint32_t> registers = {  ///< of all slaves
      {0x0005, 4},           {0x0804, 0x0001'0026}, {0x080C, 0x0001'0022}, {0x0814, 0x0001'0064},
      {0x081C, 0x0001'0020}, {0x0981, 3},           {0x0984, 0},           {0x092C, 0}};
  bool has_pulses = true;
  std::function<void()> on_exchange = [] {};
};

/// The bus of the segment.
class FakeBus final : public Bus {
 public:
  explicit FakeBus(FakeSegment& segment) : segment_(segment), outputs_(kFakeSlaves) {}

  std::vector<BusSlave> scan() override {
    std::vector<BusSlave> found;
    for (std::size_t i = 0; i < kFakeSlaves; ++i) {
      const Slave& slave = segment_.machine.slaves[i];
      found.push_back({.name = "fake",
                       .vendor = slave.vendor,
                       .product = slave.product,
                       .revision = slave.revision,
                       .serial = 0,
                       .address = static_cast<std::uint16_t>(0x1000 + i),
                       .has_clock = true,
                       .delay_ns = 0,
                       .status = kPreOp});
    }
    return found;
  }
  // process data as the machine says, each in one PDO
  ObjectResult read(std::size_t slave, ObjectKey key, std::size_t) override {
    if (const auto option = segment_.options.find(key.index); option != segment_.options.end()) {
      return {.value = static_cast<std::uint16_t>(option->second)};
    }
    const Slave& of = segment_.machine.slaves[slave];
    if (key.index == 0x1C12 || key.index == 0x1C13) {
      const std::uint32_t pdo = key.index == 0x1C12 ? 0x1600 : 0x1A00;
      return {.value = key.subindex == 0 ? 1 : pdo};
    }
    if (key.index == 0x1600) return entry(of.outputs, key.subindex);
    if (key.index == 0x1A00) return entry(of.inputs, key.subindex);
    return {.abort = 0x0602'0000};
  }
  ObjectResult write(std::size_t, ObjectKey, std::size_t, std::uint32_t) override { return {}; }
  std::optional<std::uint32_t> read_register(std::size_t, std::uint16_t address,
                                             std::size_t) override {
    if (address == 0x0990) {
      return segment_.has_pulses ? static_cast<std::uint32_t>(segment_.exchanges) : 0;
    }
    return segment_.registers[address];
  }
  bool set_watchdog(std::size_t, std::uint32_t) override { return true; }
  void use_sync(std::size_t) override {}
  int start(std::uint32_t, std::uint32_t) override {
    for (std::uint8_t& state : segment_.states) state = kSafeOp;
    return kExpected;
  }
  void operate(std::size_t, const std::function<void()>&) override {
    for (std::uint8_t& state : segment_.states) state = kOp;
  }
  Sizes sizes(std::size_t slave) override {
    const Slave& of = segment_.machine.slaves[slave];
    return {.outputs = bits_of(of.outputs) / 8, .inputs = bits_of(of.inputs) / 8};
  }

  void set_outputs(std::size_t slave, std::span<const std::uint8_t> data) noexcept override {
    outputs_[slave].assign(data.begin(), data.end());
  }
  void get_inputs(std::size_t slave, std::span<std::uint8_t> data) const noexcept override {
    if (slave < kDrives) write_bits(data, 0, 16, segment_.drives[slave].status());
  }
  int exchange(std::uint32_t) noexcept override {
    ++segment_.exchanges;
    for (std::size_t i = 0; i < kDrives; ++i) segment_.drives[i].obey(outputs_[i]);
    segment_.on_exchange();
    segment_.opens_brakes = (outputs_[kPanel][0] & 1) != 0;
    segment_.has_reset = (outputs_[kPanel][0] & 2) != 0;
    return segment_.answers ? kExpected - segment_.missing : -1;
  }
  std::uint64_t time_ns() const noexcept override {
    return static_cast<std::uint64_t>(kPeriod_ns * segment_.exchanges + segment_.phase_ns);
  }
  std::uint8_t state(std::size_t slave) const noexcept override { return segment_.states[slave]; }
  bool request_state(std::size_t slave, std::uint8_t state, std::uint32_t) noexcept override {
    segment_.states[slave] = state & 0x0F;
    return true;
  }
  std::optional<SlaveStatus> status(std::size_t slave, std::uint32_t) noexcept override {
    return SlaveStatus{.status = segment_.states[slave], .code = 0x001B};
  }

 private:
  static constexpr int kExpected = 9;

  template <typename Meaning>
  static ObjectResult entry(const std::vector<Entry<Meaning>>& entries, std::uint8_t subindex) {
    if (subindex == 0) return {.value = static_cast<std::uint32_t>(entries.size())};
    const Entry<Meaning>& at = entries[subindex - 1];
    return {.value = at.object << 16 | at.subindex << 8 | at.bits};
  }

  FakeSegment& segment_;
  std::vector<std::vector<std::uint8_t>> outputs_;
};

}  // namespace hg::ethercat

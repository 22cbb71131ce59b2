#include "hg/device/ethercat/master.h"

#include <fmt/format.h>

#include <array>
#include <cstring>

#include "hg/core/error.h"
#include "hg/core/monotonic_clock.h"
#include "hg/device/ethercat/bus_master/bus_master.h"

namespace hg::ethercat {
namespace {

constexpr std::int64_t kToOp_ns = 10'000'000'000;  // ETG.1020
constexpr std::uint32_t kToOpPatience_us = 500'000;
constexpr std::size_t kWords = 160;

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

Master::Master(const std::string& interface_name)
    : master_(bus_master_open(interface_name.c_str()), &bus_master_free) {
  check();
}

std::vector<BusSlave> Master::scan() {
  const std::size_t count = bus_master_scan(master_.get());
  check();
  std::vector<BusSlave> slaves;
  bus_slave found;
  for (std::size_t i = 0; i < count && bus_master_slave(master_.get(), i, &found); ++i) {
    slaves.push_back(slave_of(found));
  }
  return slaves;
}

// little endian on both sides
ObjectResult Master::read(std::size_t slave, ObjectKey object, std::size_t bytes) {
  ObjectResult result;
  std::uint8_t data[sizeof result.value] = {};
  result.abort =
      bus_master_read_object(master_.get(), slave, object.index, object.subindex, data, bytes);
  std::memcpy(&result.value, data, sizeof data);
  return result;
}

ObjectResult Master::write(std::size_t slave, ObjectKey object, std::size_t bytes,
                           std::uint32_t value) {
  std::uint8_t data[sizeof value];
  std::memcpy(data, &value, sizeof data);
  return {.value = value,
          .abort = bus_master_write_object(master_.get(), slave, object.index, object.subindex,
                                           data, bytes)};
}

std::optional<std::uint32_t> Master::read_register(std::size_t slave, std::uint16_t address,
                                                   std::size_t bytes) {
  std::uint32_t value = 0;
  std::uint8_t data[sizeof value] = {};
  if (!bus_master_read_register(master_.get(), slave, address, data, bytes)) return {};
  std::memcpy(&value, data, sizeof data);
  return value;
}

bool Master::set_watchdog(std::size_t slave, std::uint32_t watchdog_ms) {
  return bus_master_set_watchdog(master_.get(), slave, watchdog_ms);
}

void Master::use_sync(std::size_t slave) { bus_master_use_sync(master_.get(), slave); }

int Master::start(std::uint32_t watchdog_ms, std::uint32_t sync_ns) {
  const int expected = bus_master_start(master_.get(), watchdog_ms, sync_ns);
  check();
  return expected;
}

void Master::operate(std::size_t slaves, const std::function<void()>& wait_for_turn) {
  bus_master_operate(master_.get());
  check();
  const std::int64_t deadline = now_ns() + kToOp_ns;
  while (now_ns() < deadline) {
    wait_for_turn();
    if (exchange(kToOpPatience_us) < 0) continue;
    bool is_complete = true;
    for (std::size_t i = 0; i < slaves; ++i) is_complete = is_complete && state(i) == kOp;
    if (is_complete) return;
  }
  bus_master_explain(master_.get());
  check();
}

Master::Sizes Master::sizes(std::size_t slave) {
  Sizes sizes;
  bus_master_sizes(master_.get(), slave, &sizes.outputs, &sizes.inputs);
  return sizes;
}

void Master::set_outputs(std::size_t slave, std::span<const std::uint8_t> data) noexcept {
  bus_master_set_outputs(master_.get(), slave, data.data(), data.size());
}

void Master::get_inputs(std::size_t slave, std::span<std::uint8_t> data) const noexcept {
  bus_master_inputs(master_.get(), slave, data.data(), data.size());
}

int Master::exchange(std::uint32_t patience_us) noexcept {
  return bus_master_exchange(master_.get(), patience_us);
}

std::uint64_t Master::time_ns() const noexcept { return bus_master_time_ns(master_.get()); }

std::uint8_t Master::state(std::size_t slave) const noexcept {
  return bus_master_state(master_.get(), slave);
}

bool Master::request_state(std::size_t slave, std::uint8_t state,
                           std::uint32_t patience_us) noexcept {
  return bus_master_request_state(master_.get(), slave, state, patience_us);
}

std::optional<SlaveStatus> Master::status(std::size_t slave, std::uint32_t patience_us) noexcept {
  SlaveStatus found;
  if (!bus_master_status(master_.get(), slave, patience_us, &found.status, &found.code)) return {};
  return found;
}

void Master::check() const {
  if (const std::string error = bus_master_error(master_.get()); !error.empty()) {
    throw SetupError(error);
  }
}

std::string state_name(std::uint8_t status) {
  const auto name = [&]() -> std::string {
    switch (status & 0x0F) {
      case 1:
        return "INIT";
      case kPreOp:
        return "PRE-OP";
      case 3:
        return "BOOT";
      case kSafeOp:
        return "SAFE-OP";
      case kOp:
        return "OP";
      default:
        return fmt::format("state {}", status & 0x0F);
    }
  }();
  return (status & kErrorFlag) != 0 ? name + " + error" : name;
}

std::string status_code_words(std::uint16_t code) {
  std::array<char, kWords> text;
  bus_status_code_words(code, text.data(), text.size());
  return text.data();
}

std::string abort_words(std::int64_t abort) {
  if (abort < 0) return "does not answer";
  std::array<char, kWords> text;
  bus_abort_code_words(static_cast<std::uint32_t>(abort), text.data(), text.size());
  return fmt::format("abort code {}", text.data());
}

}  // namespace hg::ethercat

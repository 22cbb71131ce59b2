#include "hg/device/ethercat/bus_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "hg/device/ethercat/master.h"

namespace hg::ethercat {
namespace {

constexpr std::uint16_t kOutputAssignment = 0x1C12;
constexpr std::uint16_t kInputAssignment = 0x1C13;
constexpr std::uint16_t kSupportedModes = 0x6502;
constexpr std::uint8_t kMostEntries = 64;  // of a list of the slave, which may be wrong

// What a drive does when it is commanded to stop, or has to (CiA 402, and CiA 301 for a lost
// connection).
struct StopOption {
  std::uint16_t object;
  std::string_view when;
  int first, last;  // of those that the profile knows, and that stop the drive
  std::array<std::string_view, 9> words;  // from `first` on
};

constexpr std::string_view kOff = "power off at once";
constexpr std::string_view kRamp = "slows down on its ramp";
constexpr std::string_view kQuickRamp = "slows down on its quick stop ramp";
constexpr std::string_view kCurrent = "slows down at its largest current";
constexpr std::string_view kVoltage = "slows down at its largest voltage";
constexpr std::array<StopOption, 6> kStopOptions = {{
    {0x605A,
     "quick stop",
     0,
     8,
     {kOff, kRamp, kQuickRamp, kCurrent, kVoltage, "slows down on its ramp, keeps its power",
      "slows down on its quick stop ramp, keeps its power",
      "slows down at its largest current, keeps its power",
      "slows down at its largest voltage, keeps its power"}},
    {0x605B, "shutdown", 0, 1, {kOff, kRamp}},
    {0x605C, "disable operation", 0, 1, {kOff, kRamp}},
    {0x605D, "halt", 1, 4, {kRamp, kQuickRamp, kCurrent, kVoltage}},
    {0x605E, "fault", 0, 4, {kOff, kRamp, kQuickRamp, kCurrent, kVoltage}},
    {0x6007, "connection lost", 1, 3, {"fault", "power off at once", "quick stop"}},
}};

// One entry of process data as the slave maps it.
struct MappedEntry {
  std::uint32_t object = 0, subindex = 0, bits = 0;
  bool operator==(const MappedEntry&) const = default;
};

std::string text_of(const MappedEntry& entry) {
  const char* plural = entry.bits == 1 ? "" : "s";
  if (entry.object == 0) return fmt::format("a gap of {} bit{}", entry.bits, plural);
  return fmt::format("{:#06x}:{} of {} bit{}", entry.object, entry.subindex, entry.bits, plural);
}

// The comparison of one slave.
class SlaveCheck {
 public:
  SlaveCheck(Bus& bus, const Machine& machine, std::size_t position,
             std::vector<std::string>& found)
      : bus_(bus), machine_(machine), position_(position), found_(found) {}

  void identity(const BusSlave& slave) {
    const Slave& expected = machine_.slaves[position_];
    compare("vendor", slave.vendor, expected.vendor);
    compare("product", slave.product, expected.product);
    compare("revision", slave.revision, expected.revision);
    if (expected.is_synchronous && !slave.has_clock) {
      say("has no distributed clock, expected is one (synchronous: true)");
    }
  }

  void settings() {
    for (const Setting& setting : machine_.slaves[position_].settings) apply(setting);
  }

  void mode() {
    const Slave& slave = machine_.slaves[position_];
    if (slave.mode == DriveMode::kNone) return;
    const ObjectResult modes = bus_.read(position_, {kSupportedModes, 0}, 4);
    if (modes.abort != 0) return;  // optional in the profile
    const auto number = static_cast<std::uint32_t>(slave.mode);
    if ((modes.value >> (number - 1) & 1U) == 0) {
      say(fmt::format("the drive does not offer mode {} (object 0x6502 is {:#010x})", number,
                      modes.value));
    }
  }

  // Objects that a drive does not have are optional in the profile.
  void stop_options() {
    for_stop_options([&](const StopOption& option, int value) {
      if (option.first <= value && value <= option.last) return;
      say(fmt::format(
          "object {:#06x}:0, what the drive does at '{}', is {}, expected is {} to {}: with "
          "another one it may not stop",
          option.object, option.when, value, option.first, option.last));
    });
  }

  // "quick stop (0x605a): slows down on its ramp; ..."
  std::string stop_words() {
    std::string words;
    for_stop_options([&](const StopOption& option, int value) {
      words += fmt::format("{}{} ({:#06x}): {}", words.empty() ? "" : "; ", option.when,
                           option.object, option.words[value - option.first]);
    });
    return words.empty() ? "does not say how it stops" : words;
  }

  void process_data() {
    const Slave& slave = machine_.slaves[position_];
    compare_entries("outputs", kOutputAssignment, slave.outputs);
    compare_entries("inputs", kInputAssignment, slave.inputs);
  }

  void watchdog() {
    if (machine_.slaves[position_].outputs.empty()) return;
    const auto ms = static_cast<std::uint32_t>(std::lround(1e3 * machine_.watchdog_s));
    if (!bus_.set_watchdog(position_, ms)) {
      say(fmt::format("its watchdog cannot be set to {} ms", ms));
    }
  }

 private:
  template <typename Action>
  void for_stop_options(const Action& action) {
    if (machine_.slaves[position_].mode == DriveMode::kNone) return;
    for (const StopOption& option : kStopOptions) {
      const ObjectResult found = bus_.read(position_, {option.object, 0}, 2);
      if (found.abort == 0) action(option, static_cast<std::int16_t>(found.value));
      if (found.abort < 0) say(fmt::format("object {:#06x}:0 cannot be read", option.object));
    }
  }

  void say(const std::string& what) {
    found_.push_back(slave_name(machine_, position_) + ": " + what);
  }

  void compare(std::string_view what, std::uint32_t found, std::uint32_t expected) {
    if (found == expected) return;
    say(fmt::format("{} {:#010x} found, expected is {:#010x}", what, found, expected));
  }

  void apply(const Setting& setting) {
    const ObjectKey key = {static_cast<std::uint16_t>(setting.object),
                           static_cast<std::uint8_t>(setting.subindex)};
    const std::size_t bytes = setting.bits / 8;
    const auto wanted = static_cast<std::uint32_t>(std::llround(setting.value));
    const std::string object = fmt::format("object {:#06x}:{}", setting.object, setting.subindex);
    if (const auto written = bus_.write(position_, key, bytes, wanted); written.abort != 0) {
      say(fmt::format("{} does not take {:g}: {}", object, setting.value,
                      abort_words(written.abort)));
      return;
    }
    const ObjectResult read = bus_.read(position_, key, bytes);
    const std::uint32_t mask = bytes == 4 ? ~0U : (1U << (8 * bytes)) - 1U;
    if (read.abort != 0) {
      say(fmt::format("{} cannot be read: {}", object, abort_words(read.abort)));
    } else if (read.value != (wanted & mask)) {
      say(fmt::format("{} is {:#x} after {:#x} was written", object, read.value, wanted & mask));
    }
  }

  template <typename Meaning>
  void compare_entries(std::string_view what, std::uint16_t assignment,
                       const std::vector<Entry<Meaning>>& expected) {
    std::vector<MappedEntry> mapped;
    if (!read_entries(what, assignment, mapped)) return;
    for (std::size_t i = 0; i < std::min(mapped.size(), expected.size()); ++i) {
      const MappedEntry wanted = {expected[i].object, expected[i].subindex, expected[i].bits};
      if (mapped[i] == wanted) continue;
      say(fmt::format("entry {} of its {} is {}, expected is {}", i + 1, what, text_of(mapped[i]),
                      text_of(wanted)));
    }
    if (mapped.size() != expected.size()) {
      say(fmt::format("its {} have {} entries, expected are {}", what, mapped.size(),
                      expected.size()));
    }
  }

  // False: the slave does not answer.
  bool read_entries(std::string_view what, std::uint16_t assignment,
                    std::vector<MappedEntry>& entries) {
    const ObjectResult pdos = bus_.read(position_, {assignment, 0}, 1);
    if (pdos.abort != 0) {
      // a slave without a mailbox; start() compares the sizes
      const Slave& slave = machine_.slaves[position_];
      if (slave.mode != DriveMode::kNone || !slave.settings.empty()) {
        say(fmt::format("object {:#06x}, its {}, cannot be read: {}", assignment, what,
                        abort_words(pdos.abort)));
      }
      return false;
    }
    for (std::uint8_t i = 1; i <= std::min<std::uint32_t>(pdos.value, kMostEntries); ++i) {
      const ObjectResult pdo = bus_.read(position_, {assignment, i}, 2);
      if (pdo.abort == 0) read_pdo(static_cast<std::uint16_t>(pdo.value), entries);
    }
    return true;
  }

  void read_pdo(std::uint16_t pdo, std::vector<MappedEntry>& entries) {
    const ObjectResult count = bus_.read(position_, {pdo, 0}, 1);
    if (count.abort != 0) return;
    for (std::uint8_t i = 1; i <= std::min<std::uint32_t>(count.value, kMostEntries); ++i) {
      const std::uint32_t entry = bus_.read(position_, {pdo, i}, 4).value;
      entries.push_back({entry >> 16, entry >> 8 & 0xFFU, entry & 0xFFU});
    }
  }

  Bus& bus_;
  const Machine& machine_;
  std::size_t position_;
  std::vector<std::string>& found_;
};

}  // namespace

std::string slave_name(const Machine& machine, std::size_t slave) {
  return fmt::format("slave {} ({})", slave + 1, machine.slaves[slave].name);
}

std::vector<std::string> differences(Bus& bus, const std::vector<BusSlave>& found,
                                     const Machine& machine) {
  std::vector<std::string> result;
  const std::size_t expected = machine.slaves.size();
  if (found.size() != expected) {
    result.push_back(fmt::format("{} slaves found, expected are {}", found.size(), expected));
  }
  for (std::size_t i = 0; i < std::min(found.size(), expected); ++i) {
    SlaveCheck check(bus, machine, i, result);
    const std::size_t before = result.size();
    check.identity(found[i]);
    if (result.size() > before) continue;  // another slave has other objects
    check.settings();
    check.mode();
    check.stop_options();
    check.process_data();
    check.watchdog();
  }
  for (std::size_t i = expected; i < found.size(); ++i) {
    result.push_back(fmt::format("slave {}: '{}' found, expected is none", i + 1, found[i].name));
  }
  return result;
}

std::vector<std::string> stop_words(Bus& bus, const Machine& machine) {
  std::vector<std::string> result, nothing;
  for (std::size_t i = 0; i < machine.slaves.size(); ++i) {
    if (machine.slaves[i].mode == DriveMode::kNone) continue;
    result.push_back(slave_name(machine, i) + ": " +
                     SlaveCheck(bus, machine, i, nothing).stop_words());
  }
  return result;
}

}  // namespace hg::ethercat

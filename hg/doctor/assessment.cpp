#include "hg/doctor/assessment.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

namespace hg::doctor {
namespace {

namespace fs = std::filesystem;

constexpr int kSysNice = 23, kIpcLock = 14;  // capabilities, linux/capability.h
constexpr double kPriorityNeeded = 80.0;     // of the control thread, hapticgiant run --priority
constexpr double kMemoryNeeded = 512e6;      // bytes, of the program with its rings and libraries
constexpr double kIdleLatency_us = 50.0;     // to wake an idle processor; more is a warning
constexpr double kTooLate_us = 2000.0;       // no thread that is scheduled at all is as late

Assessment ok(std::string item, std::string found) {
  return {Readiness::kOk, std::move(item), std::move(found), ""};
}
Assessment warn(std::string item, std::string found, std::string fix) {
  return {Readiness::kWarn, std::move(item), std::move(found), std::move(fix)};
}
Assessment bad(std::string item, std::string found, std::string fix) {
  return {Readiness::kBad, std::move(item), std::move(found), std::move(fix)};
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// First line; empty where there is none.
std::string text_of(const fs::path& file) {
  std::string line;
  std::ifstream stream(file);
  std::getline(stream, line);
  return line;
}

// Rest of the first line that begins with `name`; empty = no such line.
std::string after(const std::string& name, const fs::path& file) {
  for (const std::string& line : lines_of(file)) {
    if (line.starts_with(name)) return line.substr(name.size());
  }
  return "";
}

bool has_word(const std::string& text, const std::string& word) {
  return (" " + text + " ").find(" " + word + " ") != std::string::npos;
}

std::string user() {
  const passwd* entry = getpwuid(geteuid());
  return entry != nullptr ? entry->pw_name : std::to_string(geteuid());
}

bool has_capability(const fs::path& root, int bit) {
  std::uint64_t bits = 0;
  std::istringstream(after("CapEff:", root / "proc/self/status")) >> std::hex >> bits;
  return ((bits >> bit) & 1U) != 0;
}

// Soft limit, as in "Max locked memory   8388608   8388608   bytes"; 0 where it is not reported.
double limit_of(const fs::path& root, const std::string& name) {
  std::istringstream words(after(name, root / "proc/self/limits"));
  std::string soft;
  words >> soft;
  if (soft == "unlimited") return std::numeric_limits<double>::infinity();
  double value = 0.0;
  std::istringstream(soft) >> value;
  return value;
}

// Bytes that may be locked.
double lockable(const fs::path& root) {
  if (has_capability(root, kIpcLock)) return std::numeric_limits<double>::infinity();
  return limit_of(root, "Max locked memory");
}

std::string grant() {
  return fmt::format(
      "sudo groupadd -f realtime && sudo usermod -aG realtime {} && printf '@realtime - rtprio "
      "95\\n@realtime - memlock unlimited\\n' | sudo tee /etc/security/limits.d/99-realtime.conf; "
      "then log in again",
      user());
}

Assessment kernel(const fs::path& root) {
  const fs::path about = root / "proc/sys/kernel";
  const std::string release = text_of(about / "osrelease");
  if (text_of(root / "sys/kernel/realtime") == "1" ||
      text_of(about / "version").find("PREEMPT_RT") != std::string::npos) {
    return ok("kernel", release + ", PREEMPT_RT");
  }
  return warn("kernel", release + ", not PREEMPT_RT: how late a thread wakes up has no bound",
              "sudo apt install linux-image-rt-amd64 && sudo reboot   (Debian; Ubuntu: sudo pro "
              "enable realtime-kernel)");
}

Assessment priority(const fs::path& root) {
  const std::string who = user() + " may ";
  if (has_capability(root, kSysNice)) return ok("priority", who + "use SCHED_FIFO");
  const double most = std::min(99.0, limit_of(root, "Max realtime priority"));
  const std::string found = fmt::format("{}use SCHED_FIFO up to {:g}", who, most);
  if (most >= kPriorityNeeded) return ok("priority", found);
  if (most > 0.0) {
    return warn("priority", fmt::format("{} only, requested is {:g}", found, kPriorityNeeded),
                fmt::format("hapticgiant run --priority {:g}, or {}", most, grant()));
  }
  return bad("priority", who + "not use SCHED_FIFO (rtprio 0)", grant());
}

Assessment memory(const fs::path& root) {
  const double most = lockable(root);
  if (std::isinf(most)) return ok("memory", "may be locked without limit");
  const std::string found = fmt::format("at most {:.0f} MiB may be locked", most / 1048576.0);
  if (most >= kMemoryNeeded) return ok("memory", found);
  return warn("memory", found + ": a page that is missing stops the loop", grant());
}

Assessment swap(const fs::path& root) {
  std::string areas;
  for (const std::string& line : lines_of(root / "proc/swaps")) {
    if (line.starts_with("Filename")) continue;
    areas += (areas.empty() ? "" : ", ") + line.substr(0, line.find_first_of(" \t"));
  }
  if (areas.empty()) return ok("swap", "none");
  if (std::isinf(lockable(root))) {
    return ok("swap", areas + "; the program's memory is locked and stays");
  }
  return warn("swap", areas, "sudo swapoff -a");
}

Assessment governor(const fs::path& root) {
  std::string found = "none: the clock is fixed, or not this system's to set";
  for (int i = 0; i < 1024; ++i) {
    const fs::path cpu = root / fmt::format("sys/devices/system/cpu/cpu{}", i);
    std::error_code ignored;
    if (!fs::exists(cpu, ignored)) break;
    const std::string name = text_of(cpu / "cpufreq/scaling_governor");
    if (!name.empty() && name != "performance") {
      return warn("governor", name + ": the processor slows down between cycles",
                  "echo performance | sudo tee "
                  "/sys/devices/system/cpu/cpu*/cpufreq/scaling_governor");
    }
    if (!name.empty()) found = name;
  }
  return ok("governor", found);
}

// Of the deepest idle state of the first processor that is not disabled.
Assessment idle(const fs::path& root) {
  std::optional<double> longest_us;
  for (int i = 0; i < 16; ++i) {
    const fs::path state = root / fmt::format("sys/devices/system/cpu/cpu0/cpuidle/state{}", i);
    double latency_us = 0.0;
    if (!(std::istringstream(text_of(state / "latency")) >> latency_us)) break;
    if (text_of(state / "disable") == "1") continue;
    longest_us = std::max(longest_us.value_or(0.0), latency_us);
  }
  if (!longest_us) return ok("idle", "no idle states are reported");
  const std::string found = fmt::format("up to {:.0f} us to wake an idle processor", *longest_us);
  if (*longest_us <= kIdleLatency_us) return ok("idle", found);
  return warn("idle", found, fmt::format("sudo cpupower idle-set -D {:.0f}", kIdleLatency_us));
}

// Number of processors in a list: "0-3,6" has five.
int count_of(const std::string& list) {
  int count = 0;
  std::istringstream parts(list);
  for (std::string part; std::getline(parts, part, ',');) {
    int first = 0, last = 0;
    char dash = 0;
    std::istringstream range(part);
    if (!(range >> first)) continue;
    count += range >> dash >> last ? std::max(0, last - first + 1) : 1;
  }
  return count;
}

Assessment processors(const fs::path& root) {
  const fs::path folder = root / "sys/devices/system/cpu";
  const int count = count_of(text_of(folder / "online"));
  if (count == 0) {
    return warn("processors", "not reported",
                "nproc says how many there are: the loop needs two or more");
  }
  if (count < 2) {
    return bad("processors", "one: whatever else runs here delays the loop",
               "a computer with two or more processors");
  }
  const std::string isolated = text_of(folder / "isolated");
  if (!isolated.empty()) {
    const std::string tickless = text_of(folder / "nohz_full");
    return ok("processors",
              fmt::format("{}; {} isolated{}: use hapticgiant run --cpu {}", count, isolated,
                          tickless.empty() || tickless == "(null)" ? ", with timer ticks" : "",
                          isolated.substr(0, isolated.find_first_of("-,"))));
  }
  return warn("processors",
              fmt::format("{}, none isolated: other programs run beside the loop", count),
              fmt::format("sudo sed -i 's/^GRUB_CMDLINE_LINUX=\"/&isolcpus={0} nohz_full={0} "
                          "rcu_nocbs={0} irqaffinity=0-{1} /' /etc/default/grub && sudo "
                          "update-grub && sudo reboot; then hapticgiant run --cpu {0}",
                          count - 1, count - 2));
}

bool has_process(const fs::path& root, const std::string& name) {
  std::error_code error;
  for (fs::directory_iterator entry(root / "proc", error), end; !error && entry != end;
       entry.increment(error)) {
    if (text_of(entry->path() / "comm") == name) return true;
  }
  return false;
}

Assessment interrupts(const fs::path& root) {
  const std::string mask = text_of(root / "proc/irq/default_smp_affinity");
  const std::string found = mask.empty() ? "affinity is not reported" : "default affinity " + mask;
  if (!has_process(root, "irqbalance")) return ok("interrupts", found);
  return warn("interrupts", found + "; irqbalance moves them to any processor",
              "sudo systemctl disable --now irqbalance");
}

Assessment clock(const fs::path& root) {
  const fs::path folder = root / "sys/devices/system/clocksource/clocksource0";
  const std::string source = text_of(folder / "current_clocksource");
  if (source.empty()) return ok("clock", "not reported");
  if (source == "tsc" || source == "kvm-clock" || source == "arch_sys_counter") {
    return ok("clock", source);
  }
  return warn("clock", source + ": each reading takes microseconds",
              has_word(text_of(folder / "available_clocksource"), "tsc")
                  ? "echo tsc | sudo tee "
                    "/sys/devices/system/clocksource/clocksource0/current_clocksource"
                  : "the kernel found the processor's own clock unstable: see dmesg | grep -i tsc");
}

Assessment machine(const fs::path& root) {
  if (!has_word(after("flags", root / "proc/cpuinfo"), "hypervisor")) {
    return ok("machine", "no hypervisor");
  }
  std::string name = text_of(root / "sys/hypervisor/type");
  if (name.empty()) name = text_of(root / "sys/class/dmi/id/sys_vendor");
  if (!name.empty()) name = " (" + name + ")";
  return warn("machine",
              "virtual" + name +
                  ": the host may stop it at any time, nothing in here can prevent "
                  "it",
              "drive a device from a computer of its own");
}

Assessment throttling(const fs::path& root) {
  const std::string share_us = text_of(root / "proc/sys/kernel/sched_rt_runtime_us");
  if (share_us == "0") {
    return bad("throttling", "real-time threads get no time at all",
               "sudo sysctl kernel.sched_rt_runtime_us=950000");
  }
  if (share_us.empty()) return ok("throttling", "not reported");
  if (share_us == "-1") return ok("throttling", "off");
  return ok("throttling",
            share_us + " us of each second may be real time: more than the loop needs");
}

}  // namespace

std::string_view to_string(Readiness level) noexcept {
  switch (level) {
    case Readiness::kOk:
      return "ok";
    case Readiness::kWarn:
      return "warn";
    case Readiness::kBad:
      return "bad";
  }
  return "unknown";
}

std::vector<Assessment> assess_computer(const fs::path& root) {
  return {kernel(root),   priority(root), memory(root),     swap(root),
          governor(root), idle(root),     processors(root), interrupts(root),
          clock(root),    machine(root),  throttling(root)};
}

Assessment assess(const Jitter& ordinary, const Jitter& real_time, bool must_hold) {
  const double period_us = 1e6 / real_time.rate_Hz;
  const Distribution us = real_time.wake_up_us.distribution();
  const bool is_real_time = real_time.thread.priority > 0;
  Assessment line;
  line.item = fmt::format("{:.0f} kHz", 1e-3 * real_time.rate_Hz);
  line.found = fmt::format(
      "{}: median {:.0f} us late, 99.9 % {:.0f} us, max {:.0f} us; ordinary thread max {:.0f} us",
      is_real_time ? fmt::format("priority {}", real_time.thread.priority) : "without priority",
      us.median, us.p99_9, us.max, ordinary.wake_up_us.distribution().max);
  if (us.max <= kGoodShare * period_us && is_real_time) return line;
  line.level = us.max > kBadShare * period_us && must_hold ? Readiness::kBad : Readiness::kWarn;
  line.fix = us.max > kTooLate_us
                 ? "the lines above, from the top; then measure again with nothing else running"
                 : "the lines above, from the top";
  return line;
}

int exit_code(const std::vector<Assessment>& lines) noexcept {
  return std::ranges::count(lines, Readiness::kBad, &Assessment::level) > 0 ? 1 : 0;
}

}  // namespace hg::doctor

#include "hg/commissioning/doctor/assessment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace hg::doctor {
namespace {

constexpr long kPriorityNeeded = 80;  // priority of the control thread, hapticgiant run --priority
// Memory of the program with its rings and libraries, bytes
constexpr double kMemoryNeeded = 512e6;
constexpr double kTooLate_us = 2000.0;  // no thread that is scheduled at all is as late

std::string grant(const std::string& user) {
  return fmt::format(
      "sudo groupadd -f realtime && sudo usermod -aG realtime {} && printf '@realtime - rtprio "
      "95\\n@realtime - memlock unlimited\\n' | sudo tee /etc/security/limits.d/99-realtime.conf; "
      "then log in again",
      user);
}

Assessment kernel(const Readings& r) {
  Assessment line{Readiness::kOk, "kernel", r.kernel + ", PREEMPT_RT", ""};
  if (r.is_realtime_kernel) return line;
  line.level = Readiness::kWarn;
  line.found = r.kernel + ", not PREEMPT_RT: how late a thread wakes up has no bound";
  line.fix =
      "sudo apt install linux-image-rt-amd64 && sudo reboot   (Debian; Ubuntu: sudo pro enable "
      "realtime-kernel)";
  return line;
}

Assessment priority(const Readings& r) {
  if (r.may_set_priority) return {Readiness::kOk, "priority", r.user + " may use SCHED_FIFO", ""};
  const long most = r.priority_max.value_or(0);
  if (most >= kPriorityNeeded) {
    return {Readiness::kOk, "priority", fmt::format("{} may use SCHED_FIFO up to {}", r.user, most),
            ""};
  }
  if (most > 0) {
    return {Readiness::kWarn, "priority",
            fmt::format("{} may use SCHED_FIFO up to {} only, requested is {}", r.user, most,
                        kPriorityNeeded),
            fmt::format("hapticgiant run --priority {}, or {}", most, grant(r.user))};
  }
  return {Readiness::kBad, "priority", r.user + " may not use SCHED_FIFO (rtprio 0)",
          grant(r.user)};
}

bool may_lock(const Readings& r) {
  return r.may_lock_memory || std::isinf(r.lock_bytes.value_or(0.0));
}

Assessment memory(const Readings& r) {
  if (may_lock(r)) {
    return {Readiness::kOk, "memory", "may be locked without limit", ""};
  }
  const double most = r.lock_bytes.value_or(0.0);
  const std::string found = fmt::format("at most {:.0f} MiB may be locked", most / 1048576.0);
  if (most >= kMemoryNeeded) return {Readiness::kOk, "memory", found, ""};
  return {Readiness::kWarn, "memory", found + ": a page that is missing stops the loop",
          grant(r.user)};
}

Assessment swap(const Readings& r) {
  if (r.swaps.empty()) return {Readiness::kOk, "swap", "none", ""};
  const std::string found = fmt::format("{}", fmt::join(r.swaps, ", "));
  if (may_lock(r)) {
    return {Readiness::kOk, "swap", found + "; the program's memory is locked and stays", ""};
  }
  return {Readiness::kWarn, "swap", found, "sudo swapoff -a"};
}

Assessment governor(const Readings& r) {
  if (r.governors.empty()) {
    return {Readiness::kOk, "governor", "none: the clock is fixed, or not this system's to set",
            ""};
  }
  const auto slow = std::ranges::find_if(
      r.governors, [](const std::string& name) { return name != "performance"; });
  if (slow == r.governors.end()) return {Readiness::kOk, "governor", "performance", ""};
  return {Readiness::kWarn, "governor", *slow + ": the processor slows down between cycles",
          "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"};
}

Assessment idle(const Readings& r) {
  if (!r.idle_latency_us) return {Readiness::kOk, "idle", "no idle states are reported", ""};
  const std::string found =
      fmt::format("up to {:.0f} us to wake an idle processor", *r.idle_latency_us);
  if (*r.idle_latency_us <= kIdleLatency_us) return {Readiness::kOk, "idle", found, ""};
  return {Readiness::kWarn, "idle", found,
          fmt::format("sudo cpupower idle-set -D {:.0f}", kIdleLatency_us)};
}

Assessment isolation(const Readings& r) {
  if (r.processors == 0) {
    return {Readiness::kWarn, "processors", "not reported",
            "nproc says how many there are: the loop needs two or more"};
  }
  if (r.processors < 2) {
    return {Readiness::kBad, "processors", "one: whatever else runs here delays the loop",
            "a computer with two or more processors"};
  }
  if (!r.isolated.empty()) {
    const std::string first = r.isolated.substr(0, r.isolated.find_first_of("-,"));
    const std::string tickless = r.tickless.empty() ? ", with timer ticks" : "";
    return {Readiness::kOk, "processors",
            fmt::format("{}; {} isolated{}: use hapticgiant run --cpu {}", r.processors, r.isolated,
                        tickless, first),
            ""};
  }
  const int last = r.processors - 1;
  return {Readiness::kWarn, "processors",
          fmt::format("{}, none isolated: other programs run beside the loop", r.processors),
          fmt::format("sudo sed -i 's/^GRUB_CMDLINE_LINUX=\"/&isolcpus={0} nohz_full={0} "
                      "rcu_nocbs={0} irqaffinity=0-{1} /' /etc/default/grub && sudo update-grub "
                      "&& sudo reboot; then hapticgiant run --cpu {0}",
                      last, last - 1)};
}

Assessment interrupts(const Readings& r) {
  const std::string mask =
      r.interrupts.empty() ? "affinity is not reported" : "default affinity " + r.interrupts;
  if (!r.has_irqbalance) return {Readiness::kOk, "interrupts", mask, ""};
  return {Readiness::kWarn, "interrupts", mask + "; irqbalance moves them to any processor",
          "sudo systemctl disable --now irqbalance"};
}

Assessment clock(const Readings& r) {
  const bool is_fast = r.clock_source == "tsc" || r.clock_source == "kvm-clock" ||
                       r.clock_source == "arch_sys_counter";
  if (is_fast || r.clock_source.empty()) {
    return {Readiness::kOk, "clock", r.clock_source.empty() ? "not reported" : r.clock_source, ""};
  }
  const bool has_tsc = (" " + r.clock_sources + " ").find(" tsc ") != std::string::npos;
  return {Readiness::kWarn, "clock", r.clock_source + ": each reading takes microseconds",
          has_tsc ? "echo tsc | sudo tee "
                    "/sys/devices/system/clocksource/clocksource0/current_clocksource"
                  : "the kernel found the processor's own clock unstable: see dmesg | grep -i tsc"};
}

Assessment machine(const Readings& r) {
  if (!r.is_virtual) return {Readiness::kOk, "machine", "no hypervisor", ""};
  const std::string name = r.hypervisor.empty() ? "" : " (" + r.hypervisor + ")";
  return {Readiness::kWarn, "machine",
          "virtual" + name + ": the host may stop it at any time, nothing in here can prevent it",
          "drive a device from a computer of its own"};
}

Assessment realtime_share(const Readings& r) {
  if (r.realtime_share_us.empty()) return {Readiness::kOk, "throttling", "not reported", ""};
  if (r.realtime_share_us == "0") {
    return {Readiness::kBad, "throttling", "real-time threads get no time at all",
            "sudo sysctl kernel.sched_rt_runtime_us=950000"};
  }
  return {
      Readiness::kOk, "throttling",
      r.realtime_share_us == "-1"
          ? "off"
          : r.realtime_share_us + " us of each second may be real time: more than the loop needs",
      ""};
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

std::vector<Assessment> assess(const Readings& r) {
  return {kernel(r),    priority(r),   memory(r), swap(r),    governor(r),      idle(r),
          isolation(r), interrupts(r), clock(r),  machine(r), realtime_share(r)};
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
  return std::ranges::any_of(lines,
                             [](const Assessment& line) { return line.level == Readiness::kBad; })
             ? 1
             : 0;
}

}  // namespace hg::doctor

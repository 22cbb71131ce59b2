#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "hg/core/test/temporary_folder.h"
#include "hg/doctor/assessment.h"
#include "hg/doctor/jitter.h"

namespace hg::doctor {
namespace {

namespace fs = std::filesystem;

// A folder that stands for / of a computer that is ready.
class Computer {
 public:
  Computer() {
    put("proc/sys/kernel/osrelease", "6.1.0-rt");
    put("proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian");
    put("sys/kernel/realtime", "1");
    put("proc/self/status", "Name:\tx\nCapEff:\t0000000000000000\n");
    limits("95", "unlimited");
    put("proc/sys/kernel/sched_rt_runtime_us", "950000");
    put("sys/devices/system/cpu/online", "0-3");
    put("sys/devices/system/cpu/isolated", "2-3");
    put("sys/devices/system/cpu/nohz_full", "2-3");
    for (const char* cpu : {"cpu0", "cpu1", "cpu2", "cpu3"}) {
      put(std::string("sys/devices/system/cpu/") + cpu + "/cpufreq/scaling_governor",
          "performance");
    }
    put("sys/devices/system/cpu/cpu0/cpuidle/state0/latency", "2");
    put("proc/irq/default_smp_affinity", "3");
    put("proc/1/comm", "systemd");
    put("proc/swaps", "Filename Type Size Used Priority\n");
    put("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
    put("sys/devices/system/clocksource/clocksource0/available_clocksource", "tsc hpet");
    put("proc/cpuinfo", "processor : 0\nflags : fpu tsc nx\n");
  }

  void put(const std::string& file, const std::string& text) {
    const fs::path path = folder_.path() / file;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text << "\n";
  }
  void limits(const std::string& priority, const std::string& memory) {
    put("proc/self/limits",
        "Limit                     Soft Limit           Hard Limit           Units\n"
        "Max locked memory         " +
            memory +
            "              unlimited            bytes\n"
            "Max realtime priority     " +
            priority + "                    99\n");
  }
  void remove(const std::string& file) { fs::remove_all(folder_.path() / file); }

  Assessment line(const std::string& item) const {
    for (const Assessment& line : assess_computer(folder_.path())) {
      if (line.item == item) return line;
    }
    ADD_FAILURE() << "no line " << item;
    return {};
  }
  std::vector<Assessment> lines() const { return assess_computer(folder_.path()); }

 private:
  TemporaryFolder folder_;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Doctor, FindsNothingWrongWithAComputerThatIsReady) {
  const Computer computer;
  for (const Assessment& line : computer.lines()) {
    EXPECT_EQ(line.level, Readiness::kOk) << line.item << ": " << line.found;
    EXPECT_EQ(line.fix, "") << line.item;
  }
  EXPECT_EQ(exit_code(computer.lines()), 0);
  EXPECT_TRUE(has(computer.line("processors").found, "--cpu 2"));
}

TEST(Doctor, ReportsTheKernel) {
  Computer computer;
  computer.remove("sys/kernel/realtime");
  EXPECT_EQ(computer.line("kernel").level, Readiness::kOk);  // older ones say it in their version
  computer.put("proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC");
  EXPECT_EQ(computer.line("kernel").level, Readiness::kWarn);
  EXPECT_TRUE(has(computer.line("kernel").fix, "linux-image-rt"));
}

TEST(Doctor, ReportsWhoMayNotBeRealTimeAndHowToChangeIt) {
  Computer computer;
  computer.limits("0", "8388608");
  EXPECT_EQ(computer.line("priority").level, Readiness::kBad);
  EXPECT_TRUE(has(computer.line("priority").fix, "limits.d"));
  EXPECT_EQ(computer.line("memory").level, Readiness::kWarn);
  EXPECT_TRUE(has(computer.line("memory").found, "8 MiB"));
  EXPECT_EQ(exit_code(computer.lines()), 1);
  computer.limits("50", "unlimited");
  EXPECT_EQ(computer.line("priority").level, Readiness::kWarn);
  EXPECT_TRUE(has(computer.line("priority").fix, "--priority 50"));
  // capabilities stand above the limits: bits 14 and 23
  computer.limits("0", "8388608");
  computer.put("proc/self/status", "CapEff:\t0000000000804000");
  EXPECT_EQ(computer.line("priority").level, Readiness::kOk);
  EXPECT_EQ(computer.line("memory").level, Readiness::kOk);
  computer.put("proc/self/status", "CapEff:\t0000000000800000");
  EXPECT_EQ(computer.line("memory").level, Readiness::kWarn);
}

TEST(Doctor, DoesNotTakeUnreportedProcessorsForOne) {
  Computer computer;
  computer.put("sys/devices/system/cpu/online", "0");
  EXPECT_EQ(computer.line("processors").level, Readiness::kBad);
  computer.remove("sys/devices/system/cpu/online");
  EXPECT_EQ(computer.line("processors").level, Readiness::kWarn);
  EXPECT_EQ(computer.line("processors").found, "not reported");
}

TEST(Doctor, ReportsWhatSlowsProcessorsDown) {
  Computer computer;
  computer.put("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave");
  EXPECT_EQ(computer.line("governor").level, Readiness::kWarn);
  EXPECT_TRUE(has(computer.line("governor").fix, "performance"));
  computer.put("sys/devices/system/cpu/cpu0/cpuidle/state1/latency", "300");
  EXPECT_EQ(computer.line("idle").level, Readiness::kWarn);
  computer.put("sys/devices/system/cpu/cpu0/cpuidle/state1/disable", "1");
  EXPECT_EQ(computer.line("idle").level, Readiness::kOk);
}

TEST(Doctor, ReportsWhatElseMayRunBesideTheLoop) {
  Computer computer;
  computer.put("sys/devices/system/cpu/isolated", "");
  EXPECT_EQ(computer.line("processors").level, Readiness::kWarn);
  EXPECT_TRUE(has(computer.line("processors").fix, "isolcpus=3 nohz_full=3 rcu_nocbs=3"));
  computer.put("sys/devices/system/cpu/online", "0");
  EXPECT_EQ(computer.line("processors").level, Readiness::kBad);
  computer.put("proc/77/comm", "irqbalance");
  EXPECT_EQ(computer.line("interrupts").level, Readiness::kWarn);
  computer.put("proc/swaps", "Filename Type\n/dev/sda2 partition\n");
  EXPECT_EQ(computer.line("swap").level, Readiness::kOk);  // memory may be locked
  computer.limits("95", "8388608");
  EXPECT_EQ(computer.line("swap").level, Readiness::kWarn);
  EXPECT_EQ(computer.line("swap").fix, "sudo swapoff -a");
}

TEST(Doctor, ReportsClockMachineAndThrottling) {
  Computer computer;
  computer.put("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet");
  EXPECT_EQ(computer.line("clock").level, Readiness::kWarn);
  EXPECT_TRUE(has(computer.line("clock").fix, "echo tsc"));
  computer.put("sys/devices/system/clocksource/clocksource0/available_clocksource", "hpet");
  EXPECT_TRUE(has(computer.line("clock").fix, "dmesg"));
  computer.put("proc/cpuinfo", "flags : fpu hypervisor nx\n");
  EXPECT_EQ(computer.line("machine").level, Readiness::kWarn);
  computer.put("proc/sys/kernel/sched_rt_runtime_us", "0");
  EXPECT_EQ(computer.line("throttling").level, Readiness::kBad);
}

TEST(Doctor, SurvivesAComputerThatReportsNothing) {
  const TemporaryFolder empty;
  const std::vector<Assessment> lines = assess_computer(empty.path());
  EXPECT_EQ(exit_code(lines), 1);  // real time is not permitted there
}

TEST(Doctor, ReadsThisComputer) {
  const std::vector<Assessment> lines = assess_computer();
  ASSERT_EQ(lines[0].item, "kernel");
  EXPECT_FALSE(lines[0].found.starts_with(",")) << "the release is missing";
  ASSERT_EQ(lines[6].item, "processors");
  EXPECT_NE(lines[6].found, "not reported");
}

Jitter jitter(double rate_Hz, int priority, double late_us) {
  Jitter jitter;
  jitter.rate_Hz = rate_Hz;
  jitter.thread.priority = priority;
  for (int i = 0; i < 1000; ++i) jitter.wake_up_us.add(3.0);
  jitter.wake_up_us.add(late_us);
  return jitter;
}

TEST(Doctor, JudgesJitterByThePeriod) {
  const Jitter ordinary = jitter(1000.0, 0, 800.0);
  const auto level = [&](int priority, double late_us, bool must_hold) {
    return assess(ordinary, jitter(1000.0, priority, late_us), must_hold).level;
  };
  EXPECT_EQ(level(80, 90.0, true), Readiness::kOk);
  EXPECT_EQ(level(80, 110.0, true), Readiness::kWarn);
  EXPECT_EQ(level(80, 510.0, true), Readiness::kBad);
  EXPECT_EQ(level(80, 510.0, false), Readiness::kWarn);
  EXPECT_EQ(level(0, 90.0, true), Readiness::kWarn);  // luck
  EXPECT_EQ(assess(ordinary, jitter(10000.0, 80, 60.0), false).level, Readiness::kWarn);
  const Assessment line = assess(ordinary, jitter(1000.0, 80, 90.0), true);
  EXPECT_EQ(line.item, "1 kHz");
  EXPECT_TRUE(has(line.found,
                  "priority 80: median 3 us late, 99.9 % 3 us, max 90 us; ordinary "
                  "thread max 800 us"))
      << line.found;
}

TEST(Doctor, MeasuresEveryPeriodOnce) {
  const Jitter measured = measure_jitter(1000.0, 0.05, {.priority = 0});
  EXPECT_EQ(measured.wake_up_us.count(), 50u);
  EXPECT_EQ(measured.thread.priority, 0);
}

}  // namespace
}  // namespace hg::doctor

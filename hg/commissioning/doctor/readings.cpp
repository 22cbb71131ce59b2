#include "hg/commissioning/doctor/readings.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <limits>
#include <sstream>
#include <system_error>

namespace hg::doctor {
namespace {

namespace fs = std::filesystem;

constexpr int kSysNice = 23, kIpcLock = 14;  // capabilities, linux/capability.h

std::string trimmed(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) {
    text.pop_back();
  }
  return text;
}

// whole content, without trailing spaces; empty where it cannot be read
std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return trimmed(text.str());
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Soft limit of a line such as "Max locked memory   8388608   8388608   bytes".
std::optional<double> limit_of(const std::vector<std::string>& lines, const std::string& name) {
  for (const std::string& line : lines) {
    if (!line.starts_with(name)) continue;
    std::istringstream words(line.substr(name.size()));
    std::string soft;
    words >> soft;
    if (soft == "unlimited") return std::numeric_limits<double>::infinity();
    double value = 0.0;
    if (std::istringstream(soft) >> value) return value;
  }
  return std::nullopt;
}

std::uint64_t capabilities(const fs::path& root) {
  for (const std::string& line : lines_of(root / "proc/self/status")) {
    if (!line.starts_with("CapEff:")) continue;
    std::uint64_t bits = 0;
    std::istringstream(line.substr(7)) >> std::hex >> bits;
    return bits;
  }
  return 0;
}

std::string user_name() {
  const passwd* entry = getpwuid(geteuid());
  return entry != nullptr ? entry->pw_name : std::to_string(geteuid());
}

// counts processors: "0-3,6" and "0" are five
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

void read_processors(const fs::path& root, Readings& readings) {
  const fs::path folder = root / "sys/devices/system/cpu";
  readings.processors = count_of(text_of(folder / "online"));
  readings.isolated = text_of(folder / "isolated");
  readings.tickless = text_of(folder / "nohz_full");
  if (readings.tickless == "(null)") readings.tickless.clear();
  for (int i = 0; i < 1024; ++i) {
    const fs::path cpu = folder / ("cpu" + std::to_string(i));
    std::error_code ignored;
    if (!fs::exists(cpu, ignored)) break;
    const std::string governor = text_of(cpu / "cpufreq/scaling_governor");
    if (!governor.empty()) readings.governors.push_back(governor);
  }
}

// latency of the deepest idle state of the first processor that is not disabled
std::optional<double> idle_latency_us(const fs::path& root) {
  std::optional<double> longest;
  for (int i = 0; i < 16; ++i) {
    const fs::path state = root / ("sys/devices/system/cpu/cpu0/cpuidle/state" + std::to_string(i));
    double latency_us = 0.0;
    if (!(std::istringstream(text_of(state / "latency")) >> latency_us)) break;
    if (text_of(state / "disable") == "1") continue;
    longest = std::max(longest.value_or(0.0), latency_us);
  }
  return longest;
}

void read_permissions(const fs::path& root, Readings& readings) {
  readings.user = user_name();
  const std::uint64_t bits = capabilities(root);
  readings.may_set_priority = ((bits >> kSysNice) & 1U) != 0;
  readings.may_lock_memory = ((bits >> kIpcLock) & 1U) != 0;
  const std::vector<std::string> limits = lines_of(root / "proc/self/limits");
  if (const auto most = limit_of(limits, "Max realtime priority")) {
    readings.priority_max = static_cast<long>(std::min(*most, 99.0));
  }
  readings.lock_bytes = limit_of(limits, "Max locked memory");
  readings.realtime_share_us = text_of(root / "proc/sys/kernel/sched_rt_runtime_us");
}

bool has_process(const fs::path& root, const std::string& name) {
  std::error_code error;
  for (fs::directory_iterator entry(root / "proc", error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string number = entry->path().filename().string();
    const bool is_process = !number.empty() && std::isdigit(number.front()) != 0;
    if (is_process && text_of(entry->path() / "comm") == name) return true;
  }
  return false;
}

void read_machine(const fs::path& root, Readings& readings) {
  for (const std::string& line : lines_of(root / "proc/cpuinfo")) {
    if (line.starts_with("flags") && (line + " ").find(" hypervisor ") != std::string::npos) {
      readings.is_virtual = true;
    }
  }
  readings.hypervisor = text_of(root / "sys/hypervisor/type");
  if (readings.hypervisor.empty()) {
    readings.hypervisor = text_of(root / "sys/class/dmi/id/sys_vendor");
  }
  const fs::path clock = root / "sys/devices/system/clocksource/clocksource0";
  readings.clock_source = text_of(clock / "current_clocksource");
  readings.clock_sources = text_of(clock / "available_clocksource");
}

}  // namespace

Readings read(const fs::path& root) {
  Readings readings;
  readings.kernel = text_of(root / "proc/sys/kernel/osrelease");
  readings.version = text_of(root / "proc/sys/kernel/version");
  readings.is_realtime_kernel = text_of(root / "sys/kernel/realtime") == "1" ||
                                readings.version.find("PREEMPT_RT") != std::string::npos;
  read_permissions(root, readings);
  read_processors(root, readings);
  read_machine(root, readings);
  readings.idle_latency_us = idle_latency_us(root);
  readings.interrupts = text_of(root / "proc/irq/default_smp_affinity");
  readings.has_irqbalance = has_process(root, "irqbalance");
  const std::vector<std::string> swaps = lines_of(root / "proc/swaps");
  for (std::size_t i = 1; i < swaps.size(); ++i) {
    readings.swaps.push_back(swaps[i].substr(0, swaps[i].find_first_of(" \t")));
  }
  return readings;
}

}  // namespace hg::doctor

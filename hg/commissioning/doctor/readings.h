/// System properties of this computer that matter for a control loop, as reported by Linux.
///
/// Read from /proc and /sys below a folder, "/" for this computer, so that tests can use another
/// one. Missing values are empty: a container or another kernel need not have them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hg::doctor {

struct Readings {
  std::string kernel;                  ///< release
  std::string version;                 ///< build version: contains PREEMPT_RT, PREEMPT_DYNAMIC, ...
  bool is_realtime_kernel = false;     ///< the kernel reports PREEMPT_RT
  std::string user;                    ///< user of this process
  bool may_set_priority = false;       ///< a capability that overrides the limit below
  std::optional<long> priority_max;    ///< RLIMIT_RTPRIO; unlimited = 99
  bool may_lock_memory = false;        ///< a capability that overrides the limit below
  std::optional<double> lock_bytes;    ///< RLIMIT_MEMLOCK; infinity = unlimited
  std::string realtime_share_us;       ///< sched_rt_runtime_us; "-1" = all of the time
  std::vector<std::string> governors;  ///< governors of the processors that have one, in order
  int processors = 0;                  ///< online
  std::string isolated;                ///< processors, "2-3"
  std::string tickless;                ///< nohz_full
  std::string interrupts;              ///< default_smp_affinity, a mask
  bool has_irqbalance = false;         ///< the service that redistributes interrupts
  std::vector<std::string> swaps;      ///< active swap areas
  std::string clock_source, clock_sources;  ///< current, available
  bool is_virtual = false;                  ///< running under a hypervisor
  std::string hypervisor;                   ///< name of the hypervisor; empty = none known
  std::optional<double> idle_latency_us;  ///< wake-up latency of the deepest idle state in use, us
};

Readings read(const std::filesystem::path& root = "/");

}  // namespace hg::doctor

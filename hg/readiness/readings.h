/// What Linux says about this computer, as far as it matters for a control loop.
///
/// Read from /proc and /sys below a folder, "/" for this computer, so that tests can put any
/// other one there. What is not there is empty: a container or another kernel need not have it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hg::readiness {

struct Readings {
  std::string kernel;                       ///< release
  std::string version;                      ///< of its build: says PREEMPT_RT, PREEMPT_DYNAMIC, ...
  bool is_realtime_kernel = false;          ///< it says so itself
  std::string user;                         ///< who runs this
  bool may_set_priority = false;            ///< a capability that stands above the limit below
  std::optional<long> priority_max;         ///< RLIMIT_RTPRIO; unlimited = 99
  bool may_lock_memory = false;             ///< a capability that stands above the limit below
  std::optional<double> lock_bytes;         ///< RLIMIT_MEMLOCK; infinity = unlimited
  std::string realtime_share_us;            ///< sched_rt_runtime_us; "-1" = all of the time
  std::vector<std::string> governors;       ///< of the processors that have one, in their order
  int processors = 0;                       ///< online
  std::string isolated;                     ///< processors, "2-3"
  std::string tickless;                     ///< nohz_full
  std::string interrupts;                   ///< default_smp_affinity, a mask
  bool has_irqbalance = false;              ///< the service that moves interrupts about
  std::vector<std::string> swaps;           ///< active swap areas
  std::string clock_source, clock_sources;  ///< current, available
  bool is_virtual = false;                  ///< a hypervisor is below
  std::string hypervisor;                   ///< its name, where it tells
  std::optional<double> idle_latency_us;    ///< to wake from the deepest idle state in use
};

Readings read(const std::filesystem::path& root = "/");

}  // namespace hg::readiness

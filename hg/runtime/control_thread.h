/// Makes a thread real time on Linux: priority, processor affinity, and resident memory.
///
/// Each part is tried on its own: a refusal by the system is reported, and the thread runs without.
#pragma once

namespace hg::runtime {

/// Real-time options of a thread; set-up data.
struct ThreadOptions {
  int priority = 80;  ///< SCHED_FIFO priority, 1..99; 0 = ordinary thread
  int cpu = -1;       ///< Only processor to run on; -1 = any
};

/// Throws SetupError naming the option that is out of range.
void check_thread_options(const ThreadOptions& options);

/// Real-time properties granted by the system. Errors are those of errno, 0 = granted or not
/// requested.
struct ThreadReport {
  int priority = 0;  ///< SCHED_FIFO priority; 0 = ordinary thread
  int priority_error = 0;
  int cpu = -1;  ///< Only processor of the thread; -1 = any
  int cpu_error = 0;
  bool is_memory_locked = false;  ///< No memory of the program can be paged out
  int memory_error = 0;
};

/// Makes the calling thread real time and pre-faults its stack. Takes milliseconds if all memory of
/// the program is fetched and locked. No allocation.
ThreadReport become_real_time(const ThreadOptions& options) noexcept;

/// Page faults of the calling thread so far; each costs microseconds, or milliseconds from disk.
long page_faults() noexcept;

}  // namespace hg::runtime

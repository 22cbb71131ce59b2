/// What makes a thread real time on Linux: priority, processor, and memory that is there already.
///
/// Each part is tried on its own: what the system refuses is reported, the thread works without.
#pragma once

namespace hg::runtime {

/// Set-up data.
struct ThreadOptions {
  int priority = 80;  ///< of SCHED_FIFO, 1..99; 0 = an ordinary thread
  int cpu = -1;       ///< the only processor it may run on; -1 = any
};

/// Throws SetupError naming the option that is out of range.
void check(const ThreadOptions& options);

/// What the system granted. Errors are those of errno, 0 = granted or not asked for.
struct ThreadReport {
  int priority = 0;  ///< of SCHED_FIFO; 0 = it is an ordinary thread
  int priority_error = 0;
  int cpu = -1;  ///< the only one it runs on; -1 = any
  int cpu_error = 0;
  bool is_memory_locked = false;  ///< nothing of the program can be paged out
  int memory_error = 0;
};

/// Makes the calling thread real time and touches the stack that it will use. Takes milliseconds
/// where all memory of the program is fetched and locked. No allocation.
ThreadReport become_real_time(const ThreadOptions& options) noexcept;

/// Page faults of the calling thread so far: each is a pause of microseconds or, from a disk, of
/// milliseconds.
long page_faults() noexcept;

}  // namespace hg::runtime

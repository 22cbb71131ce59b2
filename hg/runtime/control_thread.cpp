#include "hg/runtime/control_thread.h"

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <string>

#include "hg/core/error.h"

namespace hg::runtime {
namespace {

constexpr std::size_t kStackBytes = 512 * 1024;  // the loop uses less than 100 KiB
constexpr std::size_t kPageBytes = 4096;

int set_priority(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
}

int stay_on(int cpu) noexcept {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(cpu, &only);
  return pthread_setaffinity_np(pthread_self(), sizeof(only), &only);
}

// touches each page once, so that later calls cause no page fault
void touch_stack() noexcept {
  std::array<volatile char, kStackBytes> stack;
  for (std::size_t i = 0; i < kStackBytes; i += kPageBytes) stack[i] = static_cast<char>(i);
}

// Locks all memory: present pages stay resident, later allocations are resident at once, and the
// heap is never returned to the system.
int lock_memory() noexcept {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
}

}  // namespace

void check_thread_options(const ThreadOptions& options) {
  const auto refuse = [](const char* rule, int value) {
    throw SetupError(std::string("runtime: ") + rule + ", got " + std::to_string(value));
  };
  if (options.priority < 0 || options.priority > 99) {
    refuse("the priority must be 0..99", options.priority);
  }
  if (options.cpu < -1 || options.cpu >= CPU_SETSIZE) {
    refuse("the processor must be one of this computer", options.cpu);
  }
}

ThreadReport become_real_time(const ThreadOptions& options) noexcept {
  ThreadReport report;
  if (options.cpu >= 0) {
    report.cpu_error = stay_on(options.cpu);
    if (report.cpu_error == 0) report.cpu = options.cpu;
  }
  if (options.priority > 0) {
    report.priority_error = set_priority(options.priority);
    if (report.priority_error == 0) report.priority = options.priority;
  }
  // no use for an ordinary thread, and harmful where the limit on locked memory is too small
  if (report.priority > 0) {
    report.memory_error = lock_memory();
    report.is_memory_locked = report.memory_error == 0;
  }
  touch_stack();
  return report;
}

long page_faults() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

}  // namespace hg::runtime

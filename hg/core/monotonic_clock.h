/// Monotonic clock of all loops, ns.
#pragma once

#include <time.h>

#include <cstdint>

namespace hg {

inline constexpr std::int64_t kNanoseconds = 1'000'000'000;  ///< Nanoseconds per second

/// Present time of the monotonic clock, ns.
inline std::int64_t now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNanoseconds + now.tv_nsec;
}

/// Sleeps until `time_ns`; returns at once if it has passed.
inline void sleep_until(std::int64_t time_ns) noexcept {
  const timespec time{.tv_sec = time_ns / kNanoseconds, .tv_nsec = time_ns % kNanoseconds};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

}  // namespace hg

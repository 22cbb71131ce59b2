/// When the cycles of a run in real time are due.
///
/// A short delay is made up for by cycles that follow at once; after a stall of more than
/// kMostToMakeUp periods the missed cycles are given up, so that the device does not see a burst of
/// them. Nanoseconds of a monotonic clock. No allocation, noexcept.
#pragma once

#include <cstdint>

namespace hg::runtime {

class Schedule {
 public:
  static constexpr std::int64_t kMostToMakeUp = 10;  ///< periods

  /// The first cycle begins at `now_ns`; `period_ns` > 0.
  Schedule(std::int64_t now_ns, std::int64_t period_ns) noexcept
      : due_ns_(now_ns), period_ns_(period_ns) {}

  /// A cycle ended at `now_ns`. Returns how many cycles are late because of it.
  std::uint64_t advance(std::int64_t now_ns) noexcept {
    due_ns_ += period_ns_;
    if (now_ns <= due_ns_) return 0;
    const std::int64_t periods = (now_ns - due_ns_) / period_ns_;
    if (periods < kMostToMakeUp) return 1;  // each cycle that is made up for counts itself
    due_ns_ = now_ns;
    return static_cast<std::uint64_t>(periods + 1);
  }

  /// When the next cycle begins.
  std::int64_t due_ns() const noexcept { return due_ns_; }

 private:
  std::int64_t due_ns_;
  std::int64_t period_ns_;
};

}  // namespace hg::runtime

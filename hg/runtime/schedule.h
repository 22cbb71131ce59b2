/// When the cycles of a run in real time are due, and how late they are.
///
/// What is missed is made up for by cycles that follow at once, up to a number of periods; beyond
/// it the missed cycles are left out, so that a device does not see a burst of them, and the next
/// cycle is due at the next whole period. Nanoseconds of a monotonic clock. No allocation,
/// noexcept.
#pragma once

#include <cstdint>

namespace hg::runtime {

class Schedule {
 public:
  static constexpr std::int64_t kMostToMakeUp = 10;  ///< periods, for a device that waits

  /// The first cycle begins at `now_ns`; `period_ns` > 0; `most_to_make_up` >= 0 periods.
  Schedule(std::int64_t now_ns, std::int64_t period_ns,
           std::int64_t most_to_make_up = kMostToMakeUp) noexcept
      : due_ns_(now_ns), period_ns_(period_ns), most_to_make_up_(most_to_make_up) {}

  /// A cycle ended at `now_ns`. Returns how many cycles are late or left out because of it.
  std::uint32_t advance(std::int64_t now_ns) noexcept {
    due_ns_ += period_ns_;
    if (now_ns <= due_ns_) return 0;
    const std::int64_t periods = (now_ns - due_ns_) / period_ns_;
    if (periods < most_to_make_up_) return 1;  // each cycle that is made up for counts itself
    due_ns_ += (periods + 1) * period_ns_;
    return static_cast<std::uint32_t>(periods + 1);
  }

  /// When the next cycle begins.
  std::int64_t due_ns() const noexcept { return due_ns_; }
  std::int64_t period_ns() const noexcept { return period_ns_; }

 private:
  std::int64_t due_ns_;
  std::int64_t period_ns_;
  std::int64_t most_to_make_up_;
};

}  // namespace hg::runtime

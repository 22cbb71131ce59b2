/// Schedule of the cycles of a real-time run: due times and lateness.
///
/// Missed cycles are made up for by running them without waiting, up to a number of periods; beyond
/// it they are left out, so that the device does not see a burst, and the next cycle is due at the
/// next whole period. Nanoseconds of a monotonic clock. No allocation,
/// noexcept.
#pragma once

#include <cstdint>

namespace hg {

/// Due times of cycles with a fixed period.
class Schedule {
 public:
  /// Most periods to make up for, for a device that waits.
  static constexpr std::int64_t kMostToMakeUp = 10;

  /// The first cycle begins at `now_ns`; `period_ns` > 0; `most_to_make_up` >= 0 periods.
  Schedule(std::int64_t now_ns, std::int64_t period_ns,
           std::int64_t most_to_make_up = kMostToMakeUp) noexcept
      : due_ns_(now_ns), period_ns_(period_ns), most_to_make_up_(most_to_make_up) {}

  /// Reports the end of a cycle at `now_ns`. Returns the number of late or left-out cycles.
  std::uint32_t advance(std::int64_t now_ns) noexcept {
    due_ns_ += period_ns_;
    if (now_ns <= due_ns_) return 0;
    const std::int64_t periods = (now_ns - due_ns_) / period_ns_;
    if (periods < most_to_make_up_) return 1;  // each made-up cycle counts itself
    due_ns_ += (periods + 1) * period_ns_;
    return static_cast<std::uint32_t>(periods + 1);
  }

  /// Start of the next cycle, ns.
  std::int64_t due_ns() const noexcept { return due_ns_; }
  std::int64_t period_ns() const noexcept { return period_ns_; }

 private:
  std::int64_t due_ns_;
  std::int64_t period_ns_;
  std::int64_t most_to_make_up_;
};

}  // namespace hg

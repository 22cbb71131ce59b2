/// Pace of simulated time: slow motion, pause and single cycles. The period used in a cycle stays
/// the same.
///
/// One thread sets it, the control thread reads it: atomics only, no allocation, noexcept.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>

namespace hg::runtime {

/// Pace shared by an operator thread and the control thread.
class Pace {
 public:
  static constexpr double kSlowest = 0.1;
  static constexpr int kMostSteps = 1000;

  /// Sets the speed, 1 = real time. Returns false, without effect, outside kSlowest..1.
  [[nodiscard]] bool set_speed(double speed) noexcept {
    if (!(speed >= kSlowest && speed <= 1.0)) return false;
    speed_.store(speed);
    return true;
  }
  void pause() noexcept { is_paused_.store(true); }
  void resume() noexcept {
    steps_.store(0);
    is_paused_.store(false);
  }
  /// Runs this many more cycles of a paused run. Returns false if not paused, if `cycles` is not a
  /// positive integer, or if more than kMostSteps would be pending.
  [[nodiscard]] bool step(double cycles) noexcept {
    const bool is_number = cycles >= 1.0 && cycles == std::floor(cycles);
    if (!is_number || !is_paused_.load() || cycles + steps_.load() > kMostSteps) return false;
    steps_.fetch_add(static_cast<int>(cycles));
    return true;
  }

  double speed() const noexcept { return speed_.load(); }
  bool is_paused() const noexcept { return is_paused_.load(); }

  /// Whether the next cycle may run now; consumes a step. Control thread only, before each cycle.
  bool may_run() noexcept {
    if (!is_paused_.load()) return true;
    int steps = steps_.load();
    return steps > 0 && steps_.compare_exchange_strong(steps, steps - 1);  // retried next time
  }

 private:
  std::atomic<double> speed_{1.0};
  std::atomic<bool> is_paused_{false};
  std::atomic<int> steps_{0};
};

static_assert(std::atomic<double>::is_always_lock_free);

}  // namespace hg::runtime

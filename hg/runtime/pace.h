/// How fast simulated time passes: slow motion, pause and single cycles. The period that a cycle
/// computes with stays the same.
///
/// One thread sets it, the control thread follows: atomics only, no allocation, noexcept.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>

namespace hg::runtime {

class Pace {
 public:
  static constexpr double kSlowest = 0.1;
  static constexpr int kMostSteps = 1000;

  /// False for speeds outside kSlowest..1: nothing changes.
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
  /// Runs so many more cycles of a paused run. False when it is not paused, for what is no whole
  /// number from 1 on, and where more than kMostSteps would wait.
  [[nodiscard]] bool step(double cycles) noexcept {
    const bool is_number = cycles >= 1.0 && cycles == std::floor(cycles);
    if (!is_number || !is_paused_.load() || cycles + steps_.load() > kMostSteps) return false;
    steps_.fetch_add(static_cast<int>(cycles));
    return true;
  }

  double speed() const noexcept { return speed_.load(); }
  bool is_paused() const noexcept { return is_paused_.load(); }

  /// The control thread's side, before each cycle: whether it may run now. Takes a step.
  bool may_run() noexcept {
    if (!is_paused_.load()) return true;
    int steps = steps_.load();
    return steps > 0 && steps_.compare_exchange_strong(steps, steps - 1);  // if not, next time
  }

 private:
  std::atomic<double> speed_{1.0};
  std::atomic<bool> is_paused_{false};
  std::atomic<int> steps_{0};
};

static_assert(std::atomic<double>::is_always_lock_free);

}  // namespace hg::runtime

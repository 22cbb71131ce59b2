/// Keeps the periods of the master in step with the sync pulses of the slaves: frames pass the
/// first clock halfway between two pulses, so that all outputs are there before the next one.
///
/// Nanoseconds. No allocation, noexcept.
#pragma once

#include <algorithm>
#include <cstdint>

namespace hg::ethercat {

class Pace {
 public:
  /// The first period begins at `now_ns`.
  Pace(std::int64_t now_ns, std::int64_t period_ns) noexcept
      : due_ns_(now_ns), period_ns_(period_ns) {}

  /// Start of the next period.
  std::int64_t due_ns() const noexcept { return due_ns_; }

  /// A period has begun, at `now_ns`. What was missed is not made up for: the slaves would see a
  /// burst.
  void advance(std::int64_t now_ns) noexcept {
    const std::int64_t missed = std::max<std::int64_t>(0, now_ns - due_ns_) / period_ns_;
    due_ns_ += period_ns_ * (1 + missed);
  }

  /// The frame of this period has passed the first clock at `time_ns` of that clock, whose pulses
  /// come at its whole periods. A single late frame moves the next periods by little.
  void follow(std::uint64_t time_ns) noexcept {
    const auto phase = static_cast<std::int64_t>(time_ns % static_cast<std::uint64_t>(period_ns_));
    error_ns_ = phase - period_ns_ / 2;
    const std::int64_t most = period_ns_ / kSteps;
    due_ns_ -= std::clamp(error_ns_ / kShare, -most, most);
    settled_ = std::abs(error_ns_) < period_ns_ / kClose ? settled_ + 1 : 0;
  }

  /// The next frames have to come into step again.
  void restart() noexcept { settled_ = 0; }
  /// Whether the last frames have passed near the middle between two pulses.
  bool is_settled() const noexcept { return settled_ >= kSettled; }
  /// Whether the last frame has passed far enough from both pulses beside it.
  bool is_in_step() const noexcept { return std::abs(error_ns_) < period_ns_ / 5 * 2; }
  /// How late the last frame was, against the middle.
  std::int64_t error_ns() const noexcept { return error_ns_; }

 private:
  static constexpr std::int64_t kShare = 8;    // of an error that is corrected at once
  static constexpr std::int64_t kSteps = 100;  // largest correction, share of a period
  static constexpr std::int64_t kClose = 5;    // share of a period
  static constexpr int kSettled = 20;          // frames

  std::int64_t due_ns_;
  std::int64_t period_ns_;
  std::int64_t error_ns_ = 0;
  int settled_ = 0;
};

}  // namespace hg::ethercat

/// The relation of the run's nominal time to the clock of a lab.
#pragma once

#include <algorithm>
#include <limits>

namespace hg::lab_streaming {

/// The offset of a clock from run time. It is taken once, from the samples of the first moments,
/// and kept; it is taken again only when run time has stood still, by a pause, slow motion or a
/// computer that was too slow.
class RunClock {
 public:
  static constexpr double kFirst_s = 0.1;   ///< run time over which the offset is taken
  static constexpr double kWindow_s = 0.5;  ///< run time over which a shift must last
  static constexpr double kShift_s = 0.1;   ///< shifts up to this are lateness of whoever looks

  /// Takes note of a sample seen at `clock_s`, later than it was made by an unknown delay. Returns
  /// true when the offset has just been taken, or taken again.
  bool see(double time_s, double clock_s) noexcept {
    if (!(time_s >= window_begin_s_)) begin_window(time_s);
    least_s_ = std::min(least_s_, clock_s - time_s);
    if (time_s - window_begin_s_ < (is_known_ ? kWindow_s : kFirst_s)) return false;
    // the sample with the smallest delay counts
    const double shift_s = least_s_ - offset_s_;
    begin_window(time_s);
    if (is_known_ && shift_s <= kShift_s && shift_s >= -kShift_s) return false;
    offset_s_ += shift_s;
    is_known_ = true;
    return true;
  }

  /// The run has ended: takes the offset from what has been seen. Returns true when it has just
  /// been taken; a run without a sample has none.
  bool finish() noexcept {
    if (is_known_ || !(least_s_ < std::numeric_limits<double>::infinity())) return false;
    offset_s_ = least_s_;
    is_known_ = true;
    return true;
  }

  bool is_known() const noexcept { return is_known_; }
  double offset_s() const noexcept { return offset_s_; }  ///< clock minus run time

 private:
  void begin_window(double time_s) noexcept {
    window_begin_s_ = time_s;
    least_s_ = std::numeric_limits<double>::infinity();
  }

  bool is_known_ = false;
  double offset_s_ = 0.0;
  double window_begin_s_ = std::numeric_limits<double>::infinity();
  double least_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace hg::lab_streaming

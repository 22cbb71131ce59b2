/// Position and speed of the playback of a recording. Times are arguments.
#pragma once

#include <algorithm>

namespace hg::recording {

class Playback {
 public:
  static constexpr double kSlowest = 0.1;
  static constexpr double kFastest = 8.0;

  explicit Playback(double duration_s) : duration_s_(duration_s) {}

  /// Sets the speed; false and no effect outside kSlowest..kFastest.
  [[nodiscard]] bool set_speed(double speed) noexcept {
    if (!(speed >= kSlowest && speed <= kFastest)) return false;
    speed_ = speed;
    return true;
  }
  void pause() noexcept { is_paused_ = true; }
  /// Continues the playback; at the end it restarts.
  void resume() noexcept {
    if (is_over()) position_s_ = 0.0;
    is_paused_ = false;
  }
  /// Jumps to a time; false and no effect outside the recording.
  [[nodiscard]] bool seek(double time_s) noexcept {
    if (!(time_s >= 0.0 && time_s <= duration_s_)) return false;
    position_s_ = time_s;
    return true;
  }
  /// Advances by `elapsed_s` of the wall clock, unless paused.
  void advance(double elapsed_s) noexcept {
    if (!is_paused_) move(speed_ * elapsed_s);
  }
  /// Moves forward or back by `time_s`, at most to an end.
  void move(double time_s) noexcept {
    position_s_ = std::clamp(position_s_ + time_s, 0.0, duration_s_);
  }

  double position_s() const noexcept { return position_s_; }
  double duration_s() const noexcept { return duration_s_; }
  double speed() const noexcept { return speed_; }
  bool is_paused() const noexcept { return is_paused_; }
  bool is_over() const noexcept { return position_s_ >= duration_s_; }

 private:
  double duration_s_;
  double position_s_ = 0.0;
  double speed_ = 1.0;
  bool is_paused_ = false;
};

}  // namespace hg::recording

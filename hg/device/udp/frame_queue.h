/// Puts the frames of a remote device into order, without gaps.
///
/// A frame that is missing when a later one has arrived is filled in: moving quantities are
/// extrapolated, the rest keeps its value. More than kMostHeld in a row are not filled in: the
/// frame after the gap is returned with its own number, and the sensor check stops the device.
/// Differs from [HANDBOOK] 6.6, which stops at the third.
///
/// Pure: no socket, no clock. No allocation, noexcept.
#pragma once

#include <array>
#include <cstdint>

#include "hg/signals/frames.h"

namespace hg::udp {

class FrameQueue {
 public:
  static constexpr std::uint64_t kMostHeld = 3;
  static constexpr std::size_t kRoom = 8;

  bool is_full() const noexcept { return count_ == kRoom; }
  /// Adds a frame; not when it is_full(). False: a duplicate, or too late.
  bool push(const SensorFrame& frame) noexcept;
  /// Returns the next frame; false if it is not determined yet.
  bool pop(SensorFrame& frame) noexcept;
  /// Number of frames that were filled in.
  std::uint64_t held() const noexcept { return held_; }

 private:
  std::size_t first() const noexcept;
  void fill_in() noexcept;

  std::array<SensorFrame, kRoom> waiting_;
  std::size_t count_ = 0;
  bool is_started_ = false;
  std::uint64_t next_ = 0;  ///< number of the next frame to return
  std::uint64_t held_ = 0;
  SensorFrame last_, before_;  ///< last two frames returned
};

}  // namespace hg::udp

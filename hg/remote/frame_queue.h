/// Brings the frames of a remote device into their order, one after the other without a gap.
///
/// A frame that is missing when a later one has come is filled in: what moved goes on moving, the
/// rest keeps its value. More than kMostHeld in a row are not filled in: the frame behind the gap
/// comes out with its own number, and the sensor check stops the device ([HANDBOOK] 6.6: three in a
/// row).
///
/// Pure: no socket, no clock. No allocation, noexcept.
#pragma once

#include <array>
#include <cstdint>

#include "hg/signals/frames.h"

namespace hg::remote {

class FrameQueue {
 public:
  static constexpr std::uint64_t kMostHeld = 3;
  static constexpr std::size_t kRoom = 8;

  bool is_full() const noexcept { return count_ == kRoom; }
  /// Not when it is_full(). False: the frame has been here, or its turn is over.
  bool push(const SensorFrame& frame) noexcept;
  /// The next frame, false if it cannot be told yet.
  bool pop(SensorFrame& frame) noexcept;
  /// Frames that were filled in.
  std::uint64_t held() const noexcept { return held_; }

 private:
  std::size_t first() const noexcept;
  void fill_in() noexcept;

  std::array<SensorFrame, kRoom> waiting_;
  std::size_t count_ = 0;
  bool is_started_ = false;
  std::uint64_t next_ = 0;  ///< number of the frame that comes out next
  std::uint64_t held_ = 0;
  SensorFrame last_, before_;  ///< the last two that came out
};

}  // namespace hg::remote

#include "hg/device/udp/frame_queue.h"

#include <cmath>
#include <numbers>

namespace hg::udp {
namespace {

// extrapolated by one period at the same speed; encoders of endless joints may jump by a turn
template <typename Vector>
void extrapolate(const Vector& before, Vector& last) noexcept {
  if (before.size() != last.size()) return;
  for (int i = 0; i < last.size(); ++i) {
    last[i] += std::remainder(last[i] - before[i], 2.0 * std::numbers::pi);
  }
}

}  // namespace

bool FrameQueue::push(const SensorFrame& frame) noexcept {
  if (is_started_ && frame.sequence < next_) return false;
  for (std::size_t i = 0; i < count_; ++i) {
    if (waiting_[i].sequence == frame.sequence) return false;
  }
  waiting_[count_++] = frame;
  return true;
}

std::size_t FrameQueue::first() const noexcept {
  std::size_t first = 0;
  for (std::size_t i = 1; i < count_; ++i) {
    if (waiting_[i].sequence < waiting_[first].sequence) first = i;
  }
  return first;
}

bool FrameQueue::pop(SensorFrame& frame) noexcept {
  if (count_ == 0) return false;
  const std::size_t index = first();
  const std::uint64_t sequence = waiting_[index].sequence;
  if (is_started_ && sequence > next_ && sequence - next_ <= kMostHeld) {
    fill_in();
  } else {
    before_ = last_;
    last_ = waiting_[index];
    waiting_[index] = waiting_[--count_];
  }
  is_started_ = true;
  next_ = last_.sequence + 1;
  frame = last_;
  return true;
}

void FrameQueue::fill_in() noexcept {
  const SensorFrame before = last_;
  last_.sequence = next_;
  if (before_.sequence + 1 == before.sequence) {
    last_.time_s += before.time_s - before_.time_s;
    extrapolate(before_.q_m, last_.q_m);
    extrapolate(before_.theta_m, last_.theta_m);
    extrapolate(before_.q_p, last_.q_p);
  }
  before_ = before;
  ++held_;
}

}  // namespace hg::udp

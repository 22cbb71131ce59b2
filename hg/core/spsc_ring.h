/// Single-producer single-consumer ring: the only way data leaves the control loop.
///
/// Storage is allocated once, by the constructor. push() never blocks: a full ring drops the item
/// and counts it. One thread pushes, one thread pops.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hg {

template <typename T>
class SpscRing {
 public:
  /// Holds up to `capacity` items, at least one.
  explicit SpscRing(std::size_t capacity) : items_(capacity + 1) {}

  /// Producer only. False when the ring is full: the item is dropped and counted.
  bool push(const T& item) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    const std::size_t next = after(head);
    if (next == tail_.load(std::memory_order_acquire)) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_[head] = item;
    head_.store(next, std::memory_order_release);
    return true;
  }

  /// Producer only. Whether push() would drop; counts nothing.
  bool is_full() const noexcept {
    return after(head_.load(std::memory_order_relaxed)) == tail_.load(std::memory_order_acquire);
  }

  /// Consumer only. False when the ring is empty.
  bool pop(T& item) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    item = items_[tail];
    tail_.store(after(tail), std::memory_order_release);
    return true;
  }

  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::size_t after(std::size_t index) const noexcept {
    return index + 1 == items_.size() ? 0 : index + 1;
  }

  std::vector<T> items_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace hg

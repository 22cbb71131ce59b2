/// Which samples of a device that keeps the time come late to this computer: because of the device
/// or the network, not of whoever reads them.
///
/// Pure: no socket, no clock. No allocation, noexcept.
#pragma once

#include <cmath>
#include <cstdint>

namespace hg::udp {

class Arrivals {
 public:
  explicit Arrivals(double rate_Hz) noexcept : period_ns_(std::llround(1e9 / rate_Hz)) {}

  /// Whether a sample has come more than a period after it was due, reckoned from the newest one
  /// before it. `arrived_ns`: when it has come, by a monotonic clock.
  bool is_late(std::uint64_t sequence, std::int64_t arrived_ns) noexcept {
    if (has_newest_ && sequence <= newest_) return false;
    const auto periods = static_cast<std::int64_t>(sequence - newest_);
    const bool is_late = has_newest_ && arrived_ns - newest_ns_ > (periods + 1) * period_ns_;
    has_newest_ = true;
    newest_ = sequence;
    newest_ns_ = arrived_ns;
    return is_late;
  }

 private:
  std::int64_t period_ns_;
  bool has_newest_ = false;
  std::uint64_t newest_ = 0;
  std::int64_t newest_ns_ = 0;
};

}  // namespace hg::udp

/// Limits the rate of accepted messages. Times are arguments.
#pragma once

#include <algorithm>

namespace hg::viewer_server {

class MessageRate {
 public:
  /// Allows `rate_Hz` messages per second, and as many at once after a pause of 1 s.
  explicit MessageRate(double rate_Hz) : rate_Hz_(rate_Hz) {}

  /// Whether to accept this message; false when it exceeds the rate.
  bool admit(double now_s) noexcept {
    earn(now_s);
    if (credit_ < 1.0) return false;
    credit_ -= 1.0;
    return true;
  }

  /// Counts `amount` in any case; returns for how long, s, nothing more is to be taken.
  double charge(double amount, double now_s) noexcept {
    earn(now_s);
    credit_ -= amount;
    return std::max(0.0, -credit_ / rate_Hz_);
  }

 private:
  void earn(double now_s) noexcept {
    credit_ = std::min(rate_Hz_, credit_ + rate_Hz_ * (now_s - last_s_));
    last_s_ = now_s;
  }

  double rate_Hz_;
  double credit_ = rate_Hz_;
  double last_s_ = 0.0;
};

}  // namespace hg::viewer_server

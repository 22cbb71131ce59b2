/// Limits how many messages per second are listened to. Times are arguments.
#pragma once

#include <algorithm>

namespace hg::viewer_server {

class MessageRate {
 public:
  static constexpr double kRate_Hz = 200.0;  ///< a page sends 60 hand targets per second
  static constexpr double kBurst = 200.0;    ///< messages that may come at once after a pause

  /// False when this message is one too many.
  bool admit(double now_s) noexcept {
    credit_ = std::min(kBurst, credit_ + kRate_Hz * (now_s - last_s_));
    last_s_ = now_s;
    if (credit_ < 1.0) return false;
    credit_ -= 1.0;
    return true;
  }

 private:
  double credit_ = kBurst;
  double last_s_ = 0.0;
};

}  // namespace hg::viewer_server

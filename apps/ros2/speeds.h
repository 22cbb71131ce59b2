/// Speeds of joints whose states have none.
#pragma once

#include <cstdint>

#include "hg/core/types.h"

namespace hg::ros2 {

/// Speeds as differences of positions over the time between two states: that of their stamps where
/// these differ, otherwise that of their arrival. States may arrive in bursts: times shorter than
/// `least_s` are not divided by, the speed then follows from a later state.
class Speeds {
 public:
  explicit Speeds(double least_s) : least_s_(least_s) {}

  /// Takes a state, rad or m; times in ns, `stamp_ns` 0 where there is none. False: the speeds are
  /// what they were, or not known yet.
  bool see(const VectorM& q, std::int64_t stamp_ns, std::int64_t arrival_ns) {
    const bool has_stamps = stamp_ns != 0 && stamp_ns_ != 0 && stamp_ns != stamp_ns_;
    const double since_s =
        1e-9 * static_cast<double>(has_stamps ? stamp_ns - stamp_ns_ : arrival_ns - arrival_ns_);
    // a clock that was set back begins again
    if (has_state_ && since_s >= 0.0 && since_s < least_s_) return false;
    const bool is_known = has_state_ && since_s > 0.0;
    if (is_known) speeds_ = (q - q_) / since_s;
    has_state_ = true;
    q_ = q;
    stamp_ns_ = stamp_ns;
    arrival_ns_ = arrival_ns;
    return is_known;
  }

  /// rad/s or m/s; empty before the first time that see() was true
  const VectorM& speeds() const noexcept { return speeds_; }

 private:
  double least_s_;
  VectorM q_, speeds_;  // of the last state that counted
  std::int64_t stamp_ns_ = 0, arrival_ns_ = 0;
  bool has_state_ = false;
};

}  // namespace hg::ros2

/// First-order low-pass of sampled signals, and its delay.
///
/// y_k = p y_(k-1) + (1 - p) x_k with p = exp(-2 pi f dt): the pole of the continuous filter.
#pragma once

#include <cmath>
#include <numbers>

namespace hg::estimation {

/// Pole p of a corner at `f_Hz` > 0; 0, which lets everything through, for f_Hz = 0.
inline double low_pass_pole(double f_Hz, double dt) noexcept {
  return f_Hz > 0.0 ? std::exp(-2.0 * std::numbers::pi * f_Hz * dt) : 0.0;
}

/// Delay of slow signals by the filter, s.
inline double low_pass_delay(double pole, double dt) noexcept { return pole / (1.0 - pole) * dt; }

/// Filters the next sample x into the value y.
template <typename X, typename Y>
void low_pass(double pole, const X& x, Y& y) noexcept {
  y = pole * y + (1.0 - pole) * x;
}

}  // namespace hg::estimation

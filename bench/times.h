/// Times of tasks repeated in several passes: the fastest of each task counts, so that
/// interruptions by the system do not show.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "hg/analysis/summary.h"

namespace hg::bench {

using Clock = std::chrono::steady_clock;

inline double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

/// Fewest times for a 99.9th percentile; with fewer it equals the maximum.
inline constexpr std::size_t kEnoughForTail = 1000;

class Times {
 public:
  /// Adds a time of task `index`, us; indices grow by one in the first pass.
  void add(std::size_t index, double us);

  std::size_t count() const { return us_.size(); }
  const std::vector<double>& us() const { return us_; }
  /// Exact distribution of the fastest times; zeros without times. p99_9 is NaN with fewer than
  /// kEnoughForTail times.
  analysis::Distribution distribution() const;
  double mean() const;

 private:
  std::vector<double> us_;
};

/// Histogram bin: number of times in [low, high) us.
struct Bin {
  double low, high;
  std::size_t count;
};

/// Bins of equal width on a logarithmic axis, 20 per decade, from the first to the last time.
std::vector<Bin> histogram(const Times& times);

/// Time as text; "-" for NaN.
std::string to_text(double us, int decimals);

}  // namespace hg::bench

/// Times of things that several passes do again and again: the fastest of each counts, so that
/// interruptions by the system do not show.
#pragma once

#include <chrono>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hg/evaluation/summary.h"

namespace hg::bench {

using Clock = std::chrono::steady_clock;

inline double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

class Times {
 public:
  /// A time of thing `index`, us; indices grow by one in the first pass.
  void add(std::size_t index, double us);

  std::size_t count() const { return us_.size(); }
  const std::vector<double>& us() const { return us_; }
  /// Exact, of the fastest times; zeros when there are none.
  evaluation::Distribution distribution() const;
  double mean() const;

 private:
  std::vector<double> us_;
};

/// How many of the times lie in [low, high) us.
struct Bin {
  double low, high;
  std::size_t count;
};

/// Bins of equal width on a logarithmic axis, 20 per decade, from the first to the last time.
std::vector<Bin> histogram(const Times& times);

/// The keys median_us, p99_9_us and max_us.
void add_to(nlohmann::ordered_json& row, const evaluation::Distribution& distribution);

}  // namespace hg::bench

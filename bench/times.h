/// Times of things that several passes do again and again: the fastest of each counts, so that
/// interruptions by the system do not show.
#pragma once

#include <chrono>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/evaluation/summary.h"

namespace hg::bench {

using Clock = std::chrono::steady_clock;

inline double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

/// Of fewer times 99.9 % is nothing but the maximum.
inline constexpr std::size_t kEnoughForTail = 1000;

class Times {
 public:
  /// A time of thing `index`, us; indices grow by one in the first pass.
  void add(std::size_t index, double us);

  std::size_t count() const { return us_.size(); }
  const std::vector<double>& us() const { return us_; }
  /// Exact, of the fastest times; zeros when there are none. p99_9 is not a number when there are
  /// fewer than kEnoughForTail.
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

/// "-" for what is not a number.
std::string to_text(double us, int decimals);
/// null for what is not a number.
nlohmann::ordered_json to_json(double us);

/// The keys median_us, p99_9_us and max_us.
void add_to(nlohmann::ordered_json& row, const evaluation::Distribution& distribution);

}  // namespace hg::bench

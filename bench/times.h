/// Times of tasks repeated in several passes: the fastest of each task counts, so that
/// interruptions by the system do not show.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

namespace hg::bench {

using Clock = std::chrono::steady_clock;

inline double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

class Times {
 public:
  /// Adds a time of task `index`, us; indices grow by one in the first pass.
  void add(std::size_t index, double us);

  std::size_t count() const { return us_.size(); }
  /// The fastest time of each task, us.
  const std::vector<double>& us() const { return us_; }

 private:
  std::vector<double> us_;
};

}  // namespace hg::bench

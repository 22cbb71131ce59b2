/// Counts values in bins 1 % wide, so that hours of samples need no more memory than seconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hg {

/// Median, 99.9th percentile and maximum of a quantity.
struct Distribution {
  double median = 0.0, p99_9 = 0.0, max = 0.0;
};

/// Allocates at construction only.
class Histogram {
 public:
  /// Values below 1e-9, which count as zero, and above 1e9 are not told apart.
  void add(double value) noexcept;
  std::uint64_t count() const noexcept { return count_; }
  /// Median and percentile to 1 %, the maximum exactly; zeros when there are no values.
  Distribution distribution() const noexcept;
  /// How many values are below `bound`, to 1 % of it.
  std::uint64_t below(double bound) const noexcept;

 private:
  static constexpr std::size_t kBins = 4168;
  static std::size_t bin_of(double value) noexcept;
  double at(double share) const noexcept;

  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(kBins);
  std::uint64_t count_ = 0;
  double max_ = 0.0;
};

}  // namespace hg

/// Histogram with bins 1 % wide: memory does not grow with the number of samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hg {

/// Median, 99.9th percentile and maximum of a quantity.
struct Distribution {
  double median = 0.0, p99_9 = 0.0, max = 0.0;
};

/// Counts values in logarithmic bins. Allocates at construction only.
class Histogram {
 public:
  /// Adds a value. Values below 1e-9 (counted as zero) and above 1e9 share one bin each.
  void add(double value) noexcept;
  /// Number of values.
  std::uint64_t count() const noexcept { return count_; }
  /// Distribution of the values: median and percentile to 1 %, exact maximum; zeros without values.
  Distribution distribution() const noexcept;
  /// Number of values below `bound`, to 1 % of it.
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

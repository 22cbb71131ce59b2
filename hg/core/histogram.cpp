#include "hg/core/histogram.h"

#include <algorithm>
#include <cmath>

namespace hg {
namespace {

constexpr double kLowest = 1e-9;  // the first bin takes what is smaller
const double kLogWidth = std::log(1.01);

}  // namespace

std::size_t Histogram::bin_of(double value) noexcept {
  if (!(value > kLowest)) return 0;
  const double position = 1.0 + std::log(value / kLowest) / kLogWidth;
  return static_cast<std::size_t>(std::min(position, static_cast<double>(kBins - 1)));
}

void Histogram::add(double value) noexcept {
  ++counts_[bin_of(value)];
  ++count_;
  max_ = std::max(max_, value);
}

double Histogram::at(double share) const noexcept {
  const auto rank = static_cast<std::uint64_t>(share * static_cast<double>(count_ - 1));
  std::size_t bin = 0;
  for (std::uint64_t below = counts_[0]; below <= rank; below += counts_[bin]) ++bin;
  if (bin == 0) return 0.0;
  const double middle = static_cast<double>(bin) - 0.5;
  return std::min(kLowest * std::exp(middle * kLogWidth), max_);
}

Distribution Histogram::distribution() const noexcept {
  if (count_ == 0) return {};
  return {at(0.5), at(0.999), max_};
}

std::uint64_t Histogram::below(double bound) const noexcept {
  if (bound > max_) return count_;
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < bin_of(bound); ++bin) below += counts_[bin];
  return below;
}

}  // namespace hg

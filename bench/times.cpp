#include "bench/times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hg::bench {
namespace {

constexpr double kBinsPerDecade = 20.0;
constexpr double kShortest = 1e-3;  // us; a clock may say zero

int bin_of(double us) {
  return static_cast<int>(std::floor(kBinsPerDecade * std::log10(std::max(us, kShortest))));
}

double edge_of(int bin) { return std::pow(10.0, bin / kBinsPerDecade); }

}  // namespace

void Times::add(std::size_t index, double us) {
  if (index == us_.size()) {
    us_.push_back(us);
  } else {
    us_.at(index) = std::min(us_.at(index), us);
  }
}

analysis::Distribution Times::distribution() const {
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  if (us_.empty()) return {0.0, kNotANumber, 0.0};
  std::vector<double> sorted = us_;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(sorted.size()));
    return sorted[static_cast<std::size_t>(rank) - 1];
  };
  return {at(0.5), sorted.size() < kEnoughForTail ? kNotANumber : at(0.999), sorted.back()};
}

double Times::mean() const {
  return us_.empty()
             ? 0.0
             : std::accumulate(us_.begin(), us_.end(), 0.0) / static_cast<double>(us_.size());
}

std::vector<Bin> histogram(const Times& times) {
  if (times.count() == 0) return {};
  const auto [least, most] = std::minmax_element(times.us().begin(), times.us().end());
  const int first = bin_of(*least);
  std::vector<Bin> bins;
  for (int bin = first; bin <= bin_of(*most); ++bin) {
    bins.push_back({edge_of(bin), edge_of(bin + 1), 0});
  }
  for (const double us : times.us()) ++bins[static_cast<std::size_t>(bin_of(us) - first)].count;
  return bins;
}

std::string to_text(double us, int decimals) {
  return std::isnan(us) ? "-" : fmt::format("{:.{}f}", us, decimals);
}

}  // namespace hg::bench

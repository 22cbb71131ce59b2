/// Statistics of samples, for the tests of sensors.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace hg::simulator {

inline double mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

/// Mean of the products of deviations `lag` samples apart.
inline double covariance(const std::vector<double>& x, const std::vector<double>& y,
                         std::size_t lag = 0) {
  const double mean_x = mean(x), mean_y = mean(y);
  double sum = 0.0;
  for (std::size_t k = lag; k < x.size(); ++k) sum += (x[k] - mean_x) * (y[k - lag] - mean_y);
  return sum / static_cast<double>(x.size() - lag);
}

inline double deviation(const std::vector<double>& x) { return std::sqrt(covariance(x, x)); }

inline double correlation(const std::vector<double>& x, const std::vector<double>& y,
                          std::size_t lag = 0) {
  return covariance(x, y, lag) / (deviation(x) * deviation(y));
}

/// Allan deviation, overlapping, of samples averaged over `window` of them.
inline double allan_deviation(const std::vector<double>& x, std::size_t window) {
  std::vector<double> sums = {0.0};
  for (double value : x) sums.push_back(sums.back() + value);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k + 2 * window < sums.size(); ++k, ++count) {
    const double step = sums[k + 2 * window] - 2.0 * sums[k + window] + sums[k];
    sum += step * step;
  }
  return std::sqrt(0.5 * sum / static_cast<double>(count)) / static_cast<double>(window);
}

}  // namespace hg::simulator

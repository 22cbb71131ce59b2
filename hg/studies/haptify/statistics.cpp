#include "hg/studies/haptify/statistics.h"

#include <array>
#include <cmath>

namespace hg::haptify {

double student_t(std::size_t degrees) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, table 1.3.6.7.2
  constexpr std::array<double, 30> kTable = {
      12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
      2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
      2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
  if (degrees <= kTable.size()) return kTable[degrees - 1];
  constexpr double kNormal = 1.959964;
  // first terms of its expansion in 1 / degrees, Abramowitz and Stegun 26.7.5
  const double n = static_cast<double>(degrees), z = kNormal;
  return z + (z * z * z + z) / (4.0 * n) +
         (5.0 * std::pow(z, 5) + 16.0 * z * z * z + 3.0 * z) / (96.0 * n * n);
}

Mean mean_of(std::span<const double> values) {
  Mean result;
  result.count = values.size();
  if (values.empty()) return result;
  const double n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  result.value = sum / n;
  if (values.size() < 2) return result;
  for (const double value : values) squares += (value - result.value) * (value - result.value);
  result.half_width = student_t(values.size() - 1) * std::sqrt(squares / (n - 1.0) / n);
  return result;
}

}  // namespace hg::haptify

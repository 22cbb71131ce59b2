/// Compares two solutions of a lexicographic problem by their points alone.
#pragma once

#include <span>
#include <vector>

#include "hg/hqp/problem.h"

namespace hg::bench {

/// Relative tolerance of slack norms, as a share of 1 + norm, as in the tests against
/// tests/reference.
inline constexpr double kSlackError = 1e-6;

enum class ComparisonVerdict {
  kSame,
  kWorse,   ///< worse at the first level that differs, or better there at the expense of one above
  kBetter,  ///< better at the first level that differs, with no loss above
};

/// sqrt(sum of (weight * slack)^2) of each level at `x`, which has a number per variable.
std::vector<double> slack_norms(const hqp::Problem& problem, std::span<const double> x);

/// Compares slack norms with those of a reference, level by level. NaN is worse.
ComparisonVerdict compare(std::span<const double> norms, std::span<const double> reference);

}  // namespace hg::bench

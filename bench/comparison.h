/// Which of two solutions of a lexicographic problem is better, from nothing but the points.
#pragma once

#include <span>
#include <vector>

#include "hg/hqp/problem.h"

namespace hg::bench {

/// Of 1 + norm: two slack norms that differ by less are the same, as in the tests against
/// tests/reference.
inline constexpr double kSlackError = 1e-6;

enum class Verdict {
  kSame,
  kWorse,   ///< at the first level that differs, or better there at the expense of one above
  kBetter,  ///< at the first level that differs, with nothing given up above
};

/// sqrt(sum of (weight * slack)^2) of each level at `x`, which has a number per variable.
std::vector<double> slack_norms(const hqp::Problem& problem, std::span<const double> x);

/// Judges slack norms against those of a reference, level after level. Not a number is worse.
Verdict compare(std::span<const double> norms, std::span<const double> reference);

}  // namespace hg::bench

/// A second solver that shares nothing with the first: slow, in extended precision, from textbooks.
///
/// The cascade [HG] (2)-(6): one quadratic program per level, whose constraints keep what the
/// levels above have got. Each is solved by the proximal point method, so that only least-distance
/// programs remain: [LH74] C. Lawson, R. Hanson, Solving Least Squares Problems, 1974, ch. 23
/// (NNLS, LDP). The smallest |x| is a last level with x = 0.
#pragma once

#include <string>
#include <vector>

#include "hg/hqp/problem.h"

namespace hg::hqp {

struct SlowSolution {
  std::string doubt;  ///< why the problem is ill-posed or the result not to be trusted; else empty
  std::vector<double> slack_norms;  ///< by level: square root of the sum of (weight * slack)^2
  std::vector<double> x;
};

/// Needs a problem without bad rows.
SlowSolution solve_slowly(const Problem& problem, bool minimum_norm);

}  // namespace hg::hqp

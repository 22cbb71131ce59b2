/// Proof of optimality that shares nothing with the solver: the conditions of [HG] (2), level by
/// level, checked with dense textbook algebra.
#pragma once

#include <vector>

#include "hg/hqp/problem.h"

namespace hg::hqp {

/// How far each level is from being optimal at x: the distance of its negative gradient to the span
/// of higher equality and violated rows plus the cone of higher rows at a bound, divided by the
/// size of the gradient's terms and what rounding adds to them. One entry per level, and one for
/// |x|.
std::vector<double> optimality_gaps(const Problem& problem, const std::vector<double>& x);

/// Largest entry; without the one for |x| unless `minimum_norm`.
double largest_gap(const Problem& problem, const std::vector<double>& x, bool minimum_norm = true);

}  // namespace hg::hqp

/// Proof of optimality that shares nothing with the solver: the conditions of [HG] (2), level by
/// level, checked with dense textbook algebra; and whether a result is what solution.h says.
#pragma once

#include <string>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"

namespace hg::hqp {

/// How far each of the first `levels` levels is from being optimal at x: the distance of its
/// negative gradient to the span of higher equality and violated rows plus the cone of higher rows
/// at a bound, divided by the size of the gradient's terms and what rounding adds to them. One
/// entry per level and, when these are all, one for |x|.
std::vector<double> optimality_gaps(const Problem& problem, const std::vector<double>& x,
                                    int levels);

/// Largest entry for all levels; without the one for |x| unless `minimum_norm`.
double largest_gap(const Problem& problem, const std::vector<double>& x, bool minimum_norm = true);

/// What is wrong with a result of Solver::solve(), empty if nothing: numbers that are not finite or
/// contradict each other, states that the values do not bear out, more iterations than allowed, or
/// a level called complete whose gap is larger than `gap` (infinity: gaps and states are not
/// judged).
std::string fault_of(const Problem& problem, const SolverOptions& options, const Solution& solution,
                     double gap = 1e-6);

}  // namespace hg::hqp

/// The paper's cascade as an optional baseline: it needs the wheel eiquadprog, which the program
/// itself does not.
#pragma once

#include "hg/hqp/problem.h"

namespace hg::bench {

/// Solver function that writes problem.variables() numbers to `x`; false when the QP of a level was
/// not solved.
using BaselineSolve = bool (*)(const hqp::Problem& problem, double* x);

/// Loads the cascade from the folder of the program, once; null when absent.
BaselineSolve find_baseline();

inline constexpr const char* kHowToGetBaseline =
    "the paper's cascade was not built: `make bench` fetches eiquadprog and builds it";

}  // namespace hg::bench

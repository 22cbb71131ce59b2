/// The paper's cascade as a baseline, where it was built: it needs the wheel eiquadprog, which
/// building and running the program do not.
#pragma once

#include "hg/hqp/problem.h"

namespace hg::bench {

/// Writes problem.variables() numbers to `x`; false when the QP of a level was not solved.
using BaselineSolve = bool (*)(const hqp::Problem& problem, double* x);

/// Loads the cascade from the folder of the program, once; null when it is not there.
BaselineSolve find_baseline();

inline constexpr const char* kHowToGetBaseline =
    "the paper's cascade was not built: `make bench` fetches eiquadprog and builds it";

}  // namespace hg::bench

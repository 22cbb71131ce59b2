/// Random problems with everything that makes a solver stumble.
#pragma once

#include <cstdint>

#include "hg/hqp/problem.h"

namespace hg::hqp {

/// Sizes and kinds of rows that random_problem() draws from.
struct RandomKind {
  int max_variables = 16;
  int max_levels = 7;
  int max_rows_per_level = 9;
  bool has_integers = false;  ///< small integers only: corners where many bounds meet
  double row_decades = 0.0;   ///< rows are scaled by up to 10^+-this
  double noise = 0.0;         ///< relative error of duplicates
  double scale = 1.0;         ///< of all bounds
};

/// Dense rows, bounds, zero rows, duplicates and combinations of earlier rows; equalities, one- and
/// two-sided, infinite and equal bounds, weights, empty levels. Same seed, same problem.
Problem random_problem(std::uint32_t seed, const RandomKind& kind);

}  // namespace hg::hqp

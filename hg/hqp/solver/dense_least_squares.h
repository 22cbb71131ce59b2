/// Dense least squares by Householder QR, safe for rows of very different size.
#pragma once

namespace hg::hqp::solver {

/// Minimises |A z - e|: A (m x r, column after column, m >= r, full column rank) and e (m) are
/// overwritten; z (r) is the result; `order` (r) is scratch.
/// Rows are sorted by size and columns pivoted, which keeps small rows accurate beside large ones.
/// [Bj96] A. Bjorck, Numerical methods for least squares problems, 1996, sec. 4.4.
void solve_least_squares(int m, int r, double* A, double* e, int* order, double* z) noexcept;

}  // namespace hg::hqp::solver

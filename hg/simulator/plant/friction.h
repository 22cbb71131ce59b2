/// Dry friction by maximum dissipation: among the admissible forces those that leave the least
/// kinetic energy.
///
/// Source: [HANDBOOK] 4.3 (Drumwright and Shell). Find forces f and rates w with
///   w = A f + w_free,  lb <= f <= ub,  w = 0 inside the box, w >= 0 at lb, w <= 0 at ub;
/// A symmetric and positive definite, so there is exactly one solution. Block principal pivoting
/// that falls back to the least index (Murty; Judice and Pires): ends after at most
/// (n + 1) (kPatience + 3^n) active sets; from the set of the step before nearly always after one.
///
/// A unilateral stop is a row with f in [0, infinity); a brake is a row with an infinite box. A
/// spring in series with a row adds its compliance to the row's own entry of A: implicit, so that
/// it never adds energy.
/// No allocation, noexcept.
#pragma once

#include <array>
#include <cstdint>

#include "hg/core/types.h"

namespace hg::simulator {

/// Friction elements among which the dry friction of a joint is divided, each in series with a
/// bristle.
inline constexpr int kMaxBristles = 3;
/// Rows per joint: its friction elements, hysteresis, two flanks of its gear, and an end stop.
inline constexpr int kRowsPerJoint = kMaxBristles + 4;
inline constexpr int kMaxBoxRows = kRowsPerJoint * kMaxManipulator;
using VectorBox = VectorUpTo<kMaxBoxRows>;
using MatrixBox = MatrixUpTo<kMaxBoxRows, kMaxBoxRows>;

struct BoxProblem {
  MatrixBox A;       ///< rate per force (n x n), both triangles
  VectorBox w_free;  ///< rates without these forces
  VectorBox lb, ub;  ///< bounds, lb <= 0 <= ub; infinite ends are allowed
};

enum class BoxState : std::uint8_t {
  kHeld = 0,   ///< w = 0
  kLower = 1,  ///< f = lb
  kUpper = 2,  ///< f = ub
};

/// Solution, and initial guess of the next search: `state` is read before it is written.
struct BoxSolution {
  VectorBox f, w;
  std::array<BoxState, kMaxBoxRows> state{};
  int tries = 0;         ///< active sets tried
  bool is_exact = true;  ///< false: stopped after kMaxTries; f still lies inside the box
};

inline constexpr int kPatience = 3;  ///< block steps without progress before the least-index rule
/// Cap on active sets; never reached, see the property tests
inline constexpr int kMaxTries = 1000;

void solve(const BoxProblem& problem, BoxSolution& solution) noexcept;

}  // namespace hg::simulator

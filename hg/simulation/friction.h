/// Dry friction by maximum dissipation: among the admissible forces those that leave the least
/// kinetic energy.
///
/// Source: [HANDBOOK] 4.3 (Drumwright and Shell). Find forces f and rates w with
///   w = A f + w_free,  lb <= f <= ub,  w = 0 inside the box, w >= 0 at lb, w <= 0 at ub;
/// A symmetric and positive definite, so there is exactly one solution. Block principal pivoting
/// that falls back to the least index (Murty; Judice and Pires): ends after at most
/// (n + 1) (kPatience + 3^n) active sets; from the set of the step before nearly always after one.
///
/// A unilateral stop is a row with f in [0, infinity); a brake one with an infinite box. A spring
/// in series with a row adds its give per force to the row's own entry of A: implicit, so that it
/// never adds energy.
/// No allocation, noexcept.
#pragma once

#include <array>
#include <cstdint>

#include "hg/core/types.h"

namespace hg::simulation {

/// Elements that the dry friction of a joint is shared out to, each in series with a bristle.
inline constexpr int kMaxBristles = 3;
/// Per joint: elements of its friction, hysteresis, two flanks of its gear, and an end stop.
inline constexpr int kRowsPerJoint = kMaxBristles + 4;
inline constexpr int kMaxBoxRows = kRowsPerJoint * kMaxManipulator;
using VectorBox = VectorUpTo<kMaxBoxRows>;
using MatrixBox = MatrixUpTo<kMaxBoxRows, kMaxBoxRows>;

struct BoxProblem {
  MatrixBox A;       ///< rate per force (n x n), both triangles
  VectorBox w_free;  ///< rates without these forces
  VectorBox lb, ub;  ///< lb <= 0 <= ub; infinite ends are allowed
};

enum class BoxState : std::uint8_t {
  kHeld = 0,   ///< w = 0
  kLower = 1,  ///< f = lb
  kUpper = 2,  ///< f = ub
};

/// Also the start of the next search: `state` is read before it is written.
struct BoxSolution {
  VectorBox f, w;
  std::array<BoxState, kMaxBoxRows> state{};
  int tries = 0;         ///< active sets tried
  bool is_exact = true;  ///< false: gave up after kMaxTries; f is inside the box all the same
};

inline constexpr int kPatience = 3;     ///< block steps without progress before the least index
inline constexpr int kMaxTries = 1000;  ///< never met: see the property tests

void solve(const BoxProblem& problem, BoxSolution& solution) noexcept;

}  // namespace hg::simulation

/// Problems made of bytes: for fuzzing, and for random tests whose failures shrink.
///
/// Any bytes make a problem; fewer bytes, or zeros instead of others, make a simpler one. A head of
/// kHeadBytes, then kRowBytes per row: small integers or fractions, duplicates and sums of earlier
/// rows, zero rows, one- and two-sided, infinite and equal bounds, weights, empty levels.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"

namespace hg::hqp {

struct ByteProblem {
  static constexpr int kHeadBytes = 2;
  static constexpr int kRowBytes = 16;
  static constexpr int kChanges = 2;
  static constexpr Capacity kCapacity = {.variables = 8, .levels = 16, .rows = 128};

  /// What the bytes may contain beyond numbers of order 1.
  enum class Numbers : std::uint8_t {
    kTame,     ///< nothing: well-posed, but for rare accidents
    kScaled,   ///< rows 1e-9 and 1e9 times as large as others, bounds too
    kSpecial,  ///< also NaN, infinity, the largest and smallest numbers, lb > ub: bad rows
  };

  ByteProblem(std::span<const std::uint8_t> bytes, Numbers numbers);

  /// The next problem of a sequence, 0 <= step < kChanges: bounds move, come, go and contradict.
  void change(int step) noexcept;

  Problem problem;
  SolverOptions options;  ///< minimum_norm and max_iterations vary
  ActiveSet guess;        ///< to start from, mostly a cold start
  bool is_tame = true;    ///< no scaled or special number has been used

 private:
  void add_row(std::span<const std::uint8_t> bytes, Numbers numbers);

  std::vector<std::array<std::uint8_t, kChanges>> changes_;  ///< by row
};

}  // namespace hg::hqp

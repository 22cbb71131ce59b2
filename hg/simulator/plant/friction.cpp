#include "hg/simulator/plant/friction.h"

#include <cmath>

#include "hg/simulator/plant/cholesky.h"

namespace hg::simulator {
namespace {

// Rounding error of a rate, relative to its summands; smaller rates count as zero.
constexpr double kRounding = 1e-12;

struct Rows {
  std::array<int, kMaxBoxRows> row{};
  int count = 0;

  void add(int i) noexcept { row[count++] = i; }
  int operator[](int k) const noexcept { return row[k]; }
};

BoxState& state_of(BoxSolution& s, int i) noexcept { return s.state[i]; }

// Forces and rates of the active set given by `s.state`.
void solve_for_states(const BoxProblem& problem, BoxSolution& s) noexcept {
  const int n = static_cast<int>(problem.w_free.size());
  Rows held;
  for (int i = 0; i < n; ++i) {
    const BoxState state = state_of(s, i);
    s.f[i] = state == BoxState::kLower ? problem.lb[i] : problem.ub[i];
    if (state == BoxState::kHeld) {
      s.f[i] = 0.0;
      held.add(i);
    }
  }
  s.w.noalias() = problem.A.lazyProduct(s.f);
  s.w += problem.w_free;
  if (held.count == 0) return;

  MatrixBox L(held.count, held.count);
  VectorBox f(held.count);
  for (int j = 0; j < held.count; ++j) {
    f[j] = -s.w[held[j]];
    for (int i = j; i < held.count; ++i) L(i, j) = problem.A(held[i], held[j]);
  }
  factorise(L);
  solve_lower(L, f);
  solve_upper(L, f);
  for (int k = 0; k < held.count; ++k) {
    s.f[held[k]] = f[k];
    s.w += problem.A.col(held[k]) * f[k];
  }
  for (int k = 0; k < held.count; ++k) s.w[held[k]] = 0.0;
}

// State that row i should have; its present one if consistent.
BoxState wanted_state(const BoxProblem& problem, const BoxSolution& s, int i) noexcept {
  const BoxState state = s.state[i];
  if (problem.lb[i] == problem.ub[i]) return BoxState::kLower;
  if (state == BoxState::kHeld) {
    if (s.f[i] > problem.ub[i]) return BoxState::kUpper;
    if (s.f[i] < problem.lb[i]) return BoxState::kLower;
    return BoxState::kHeld;
  }
  const double against = state == BoxState::kLower ? -s.w[i] : s.w[i];
  if (against <= 0.0) return state;
  const double terms =
      std::abs(problem.w_free[i]) + problem.A.row(i).transpose().cwiseAbs().dot(s.f.cwiseAbs());
  return against > kRounding * terms ? BoxState::kHeld : state;
}

// Enforces the box and the complementarity exactly, whatever rounding left.
void tidy(const BoxProblem& problem, BoxSolution& s) noexcept {
  for (int i = 0; i < s.f.size(); ++i) {
    if (problem.lb[i] == problem.ub[i]) continue;
    const BoxState state = state_of(s, i);
    if (state == BoxState::kLower) s.w[i] = std::max(s.w[i], 0.0);
    if (state == BoxState::kUpper) s.w[i] = std::min(s.w[i], 0.0);
    if (!s.is_exact) s.f[i] = std::clamp(s.f[i], problem.lb[i], problem.ub[i]);
  }
}

}  // namespace

void solve(const BoxProblem& problem, BoxSolution& s) noexcept {
  const int n = static_cast<int>(problem.w_free.size());
  s.f.resize(n);
  s.w.resize(n);
  for (int i = 0; i < n; ++i) {
    const bool is_open = (state_of(s, i) == BoxState::kLower && std::isinf(problem.lb[i])) ||
                         (state_of(s, i) == BoxState::kUpper && std::isinf(problem.ub[i]));
    if (is_open) state_of(s, i) = BoxState::kHeld;
    if (problem.lb[i] == problem.ub[i]) state_of(s, i) = BoxState::kLower;
  }

  int fewest = n + 1, patience = kPatience;
  for (s.tries = 1; s.tries <= kMaxTries; ++s.tries) {
    solve_for_states(problem, s);
    std::array<BoxState, kMaxBoxRows> wanted{};
    Rows wrong;
    for (int i = 0; i < n; ++i) {
      wanted[i] = wanted_state(problem, s, i);
      if (wanted[i] != state_of(s, i)) wrong.add(i);
    }
    s.is_exact = wrong.count == 0;
    if (s.is_exact) break;

    // all wrong rows at once while that helps, else the first one alone
    if (wrong.count < fewest) {
      fewest = wrong.count;
      patience = kPatience;
    } else if (patience > 0) {
      --patience;
    }
    const int changes = patience > 0 ? wrong.count : 1;
    for (int k = 0; k < changes; ++k) {
      state_of(s, wrong[k]) = wanted[wrong[k]];
    }
  }
  tidy(problem, s);
}

}  // namespace hg::simulator

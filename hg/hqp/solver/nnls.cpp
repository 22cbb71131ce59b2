#include "hg/hqp/solver/nnls.h"

#include <algorithm>

#include "hg/hqp/solver/rows.h"

namespace hg::hqp::solver {
namespace {

// Residual below this share of the gradient's terms counts as zero
constexpr double kRoundOff = 1e-14;
constexpr double kParallel = 1e-10;  // cosine below which a row does not oppose a direction
constexpr int kChangesPerRow = 4;    // bound on the loop; convergence mostly needs one per row

}  // namespace

Nnls::Nnls(int max_variables, int max_candidates)
    : rows_(max_variables),
      mu_(max_variables),
      mu_new_(max_variables),
      is_excluded_(max_candidates),
      candidate_(max_variables),
      descent_(max_variables),
      rest_(max_variables) {}

int Nnls::most_opposed(const Problem& problem, const std::vector<RowAtBound>& candidates,
                       double descent_norm) const noexcept {
  int best = -1;
  double best_cosine = kParallel;
  for (int i = 0; i < static_cast<int>(candidates.size()); ++i) {
    if (is_excluded_[i]) continue;
    const auto [row, sign] = candidates[i];
    const double cosine =
        sign * dot(problem, row, descent_.data()) / (problem.norm(row) * descent_norm);
    if (cosine > best_cosine) {
      best_cosine = cosine;
      best = i;
    }
  }
  return best;
}

// Multipliers of the pivots above `base` that cancel g in their span, of any sign.
void Nnls::solve_passive(const Problem& problem, const double* g, int base,
                         const HouseholderQr& elimination) noexcept {
  const int n = problem.variables();
  rest_.head(n) = VectorView(g, n);
  for (int i = size_ - 1; i >= 0; --i) {
    const int t = base + i;
    const double multiplier =
        -VectorView(elimination.column(t), n).dot(rest_.head(n)) / elimination.pivot(t);
    add_multiple(problem, elimination.pivot_row(t), multiplier, rest_.data());
    mu_new_[i] = rows_[i].sign * multiplier;
  }
}

// Moves from mu_ towards mu_new_ until the first multiplier vanishes, and drops the vanished ones.
void Nnls::remove_non_positive(const Problem& problem, int base, double rank_tolerance,
                               HouseholderQr& elimination) noexcept {
  double fraction = 1.0;
  int first_to_vanish = 0;
  for (int i = 0; i < size_; ++i) {
    if (mu_new_[i] > 0.0) continue;
    const double fraction_i = mu_[i] / (mu_[i] - mu_new_[i]);
    if (fraction_i <= fraction) {
      fraction = fraction_i;
      first_to_vanish = i;
    }
  }
  mu_.head(size_) += fraction * (mu_new_ - mu_).head(size_);
  mu_[first_to_vanish] = 0.0;

  elimination.truncate(base);
  int count = 0;
  for (int i = 0; i < size_; ++i) {
    if (mu_[i] > 0.0 && elimination.add_row(problem, rows_[i].row, rank_tolerance)) {
      rows_[count] = rows_[i];
      candidate_[count] = candidate_[i];
      mu_[count++] = mu_[i];
    } else {
      is_excluded_[candidate_[i]] = false;
    }
  }
  size_ = count;
}

void Nnls::solve(const Problem& problem, const std::vector<RowAtBound>& candidates, const double* g,
                 double g_scale, double rank_tolerance, HouseholderQr& elimination) noexcept {
  const int n = problem.variables();
  const int base = elimination.rank();
  const int max_changes = kChangesPerRow * (static_cast<int>(candidates.size()) + 1);
  std::fill_n(is_excluded_.begin(), candidates.size(), false);
  size_ = 0;

  for (int change = 0; change < max_changes; ++change) {
    elimination.project_to_free(g, descent_.data());
    descent_.head(n) *= -1.0;
    const double descent_norm = descent_.head(n).norm();
    if (!(descent_norm > kRoundOff * g_scale)) break;

    const int entering = most_opposed(problem, candidates, descent_norm);
    if (entering < 0) break;
    is_excluded_[entering] = true;
    const RowAtBound candidate = candidates[entering];
    if (!elimination.add_row(problem, candidate.row, rank_tolerance)) continue;
    rows_[size_] = candidate;
    candidate_[size_] = entering;
    mu_[size_++] = 0.0;

    solve_passive(problem, g, base, elimination);
    if (!(mu_new_[size_ - 1] > 0.0)) {  // rounding: the row does not oppose after all
      --size_;
      elimination.truncate(base + size_);
      continue;
    }
    while (size_ > 0 && mu_new_.head(size_).minCoeff() <= 0.0) {
      remove_non_positive(problem, base, rank_tolerance, elimination);
      solve_passive(problem, g, base, elimination);
    }
    mu_.head(size_) = mu_new_.head(size_);
  }
}

}  // namespace hg::hqp::solver

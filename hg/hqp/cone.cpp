#include "hg/hqp/cone.h"

#include <algorithm>

#include "hg/hqp/rows.h"

namespace hg::hqp {
namespace {

// Residual below this share of the gradient's terms counts as zero
constexpr double kRoundOff = 1e-14;
constexpr double kParallel = 1e-10;  // cosine below which a row does not oppose a direction
constexpr int kChangesPerRow = 4;    // bound on the loop; convergence mostly needs one per row

}  // namespace

Cone::Cone(int max_variables, int max_candidates)
    : rows_(at(max_variables)),
      mu_(max_variables),
      mu_new_(max_variables),
      is_barred_(at(max_candidates)),
      candidate_(at(max_variables)),
      descent_(max_variables),
      rest_(max_variables) {}

int Cone::most_opposed(const Problem& problem, const std::vector<TouchedRow>& candidates,
                       double descent_norm) const noexcept {
  int best = -1;
  double best_cosine = kParallel;
  for (int i = 0; i < static_cast<int>(candidates.size()); ++i) {
    if (is_barred_[at(i)]) continue;
    const auto [row, sign] = candidates[at(i)];
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
void Cone::solve_passive(const Problem& problem, const double* g, int base,
                         const Elimination& elimination) noexcept {
  const int n = problem.variables();
  rest_.head(n) = VectorView(g, n);
  for (int i = size_ - 1; i >= 0; --i) {
    const int t = base + i;
    const double multiplier =
        -VectorView(elimination.column(t), n).dot(rest_.head(n)) / elimination.pivot(t);
    add_multiple(problem, elimination.pivot_row(t), multiplier, rest_.data());
    mu_new_[i] = rows_[at(i)].sign * multiplier;
  }
}

// Moves from mu_ towards mu_new_ until the first multiplier vanishes, and drops the vanished ones.
void Cone::remove_non_positive(const Problem& problem, int base, double rank_tolerance,
                               Elimination& elimination) noexcept {
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
  int kept = 0;
  for (int i = 0; i < size_; ++i) {
    if (mu_[i] > 0.0 && elimination.add_row(problem, rows_[at(i)].row, rank_tolerance)) {
      rows_[at(kept)] = rows_[at(i)];
      candidate_[at(kept)] = candidate_[at(i)];
      mu_[kept++] = mu_[i];
    } else {
      is_barred_[at(candidate_[at(i)])] = false;
    }
  }
  size_ = kept;
}

void Cone::solve(const Problem& problem, const std::vector<TouchedRow>& candidates, const double* g,
                 double g_scale, double rank_tolerance, Elimination& elimination) noexcept {
  const int n = problem.variables();
  const int base = elimination.rank();
  const int max_changes = kChangesPerRow * (static_cast<int>(candidates.size()) + 1);
  std::fill_n(is_barred_.begin(), candidates.size(), false);
  size_ = 0;

  for (int change = 0; change < max_changes; ++change) {
    elimination.project_to_free(g, descent_.data());
    descent_.head(n) *= -1.0;
    const double descent_norm = descent_.head(n).norm();
    if (!(descent_norm > kRoundOff * g_scale)) break;

    const int entering = most_opposed(problem, candidates, descent_norm);
    if (entering < 0) break;
    is_barred_[at(entering)] = true;
    const TouchedRow touched = candidates[at(entering)];
    if (!elimination.add_row(problem, touched.row, rank_tolerance)) continue;
    rows_[at(size_)] = touched;
    candidate_[at(size_)] = entering;
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

}  // namespace hg::hqp

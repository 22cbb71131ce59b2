#include "hg/hqp/test/slow_solver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hg::hqp {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

// A relative size above the upper of two thresholds counts, one below the lower does not; what is
// in between makes the problem ill-posed.
struct Threshold {
  Real none;
  Real some;
};
constexpr Threshold kFreePart = {1e-12L, 1e-6L};   // of a row, beside the rows above
constexpr Threshold kViolation = {1e-13L, 1e-8L};  // of a bound, beside |bound| + |c| |x|
constexpr Threshold kPush = {1e-13L, 1e-7L};       // of a row above, beside the level's gradient
constexpr Real kProximity = 1e-4L;                 // weight of |x - last x|^2
constexpr Real kStandstill = 1e-12L;   // step, beside the slack, that ends the proximal method
constexpr int kMaxSteps = 300;         // of the proximal method
constexpr Real kNonNegative = 1e-16L;  // cosine that opposes the residual in NNLS

// min |E u - f| over u >= 0, columns of E of length 1; false when the loop does not end.
bool solve_non_negative(const Matrix& E, const Vector& f, Vector& u) {
  const Eigen::Index m = E.cols();
  u = Vector::Zero(m);
  std::vector<Eigen::Index> passive;
  std::vector<bool> is_excluded(m, false);  // passive, or refused at this point
  for (int step = 0; step < 20 * (m + 1); ++step) {
    const Vector w = E.transpose() * (f - E * u);
    Eigen::Index entering = -1;
    for (Eigen::Index j = 0; j < m; ++j) {
      if (is_excluded[j] || w[j] <= kNonNegative) continue;
      if (entering < 0 || w[j] > w[entering]) entering = j;
    }
    if (entering < 0) return true;
    is_excluded[entering] = true;
    passive.push_back(entering);

    bool has_moved = false;
    while (true) {
      Eigen::ColPivHouseholderQR<Matrix> qr(E(Eigen::all, passive));
      qr.setThreshold(1e-13L);
      const Vector z = qr.solve(f);
      if (!has_moved && (qr.rank() < z.size() || !(z[z.size() - 1] > 0.0L))) {
        passive.pop_back();  // depends on the others, up to rounding
        break;
      }
      if (!has_moved) {
        has_moved = true;
        std::fill(is_excluded.begin(), is_excluded.end(), false);
        for (const Eigen::Index j : passive) is_excluded[j] = true;
      }
      // towards z until the first u vanishes
      Real fraction = 1.0L;
      Eigen::Index leaving = -1;
      for (Eigen::Index k = 0; k < z.size(); ++k) {
        const Real u_k = u[passive[k]];
        if (z[k] > 0.0L || u_k / (u_k - z[k]) >= fraction) continue;
        fraction = u_k / (u_k - z[k]);
        leaving = k;
      }
      for (Eigen::Index k = 0; k < z.size(); ++k) {
        Real& u_k = u[passive[k]];
        u_k += fraction * (z[k] - u_k);
      }
      if (leaving < 0) break;
      u[passive[leaving]] = 0.0L;
      is_excluded[passive[leaving]] = false;
      passive.erase(passive.begin() + leaving);
    }
  }
  return false;
}

// min |z| with G z >= h, and the multipliers G^T mu = z, mu >= 0.
bool find_least_distance(const Matrix& G, const Vector& h, Vector& z, Vector& mu) {
  Matrix E(G.cols() + 1, G.rows());
  E.topRows(G.cols()) = G.transpose();
  E.bottomRows(1) = h.transpose();
  Vector length = E.colwise().norm().transpose();
  for (Eigen::Index j = 0; j < E.cols(); ++j) {
    if (length[j] == 0.0L) length[j] = 1.0L;
    E.col(j) /= length[j];
  }
  const Vector f = Vector::Unit(E.rows(), E.rows() - 1);
  if (!solve_non_negative(E, f, mu)) return false;
  const Vector residual = f - E * mu;
  const Real factor = residual[E.rows() - 1];
  if (!(factor > 1e-6L)) return false;  // nothing is feasible
  z = -residual.head(G.cols()) / factor;
  mu = mu.cwiseQuotient(length) / factor;
  return true;
}

// One side of a row: c x <= bound.
struct Side {
  Vector c;
  Real bound;
  Real norm;    // of c
  Real weight;  // of the slack
};

// Both sides of a row, as far as they are finite.
std::vector<Side> sides_of_row(const Problem& problem, int row) {
  Vector c = Vector::Zero(problem.variables());
  if (problem.variable(row) >= 0) c[problem.variable(row)] = 1.0L;
  const auto coefficients = problem.coefficients(row);
  std::copy(coefficients.begin(), coefficients.end(), c.begin());
  const auto [lb, ub] = problem.bounds(row);
  const Real weight = problem.weight(row);
  std::vector<Side> sides;
  if (std::isfinite(ub)) sides.push_back({c, ub, c.norm(), weight});
  if (std::isfinite(lb)) sides.push_back({-c, -lb, c.norm(), weight});
  return sides;
}

class Cascade {
 public:
  explicit Cascade(const Problem& problem)
      : problem_(problem),
        n_(problem.variables()),
        x_(Vector::Zero(n_)),
        free_(Matrix::Identity(n_, n_)) {}

  SlowSolution run(bool minimum_norm) {
    for (int level = 0; level < problem_.levels(); ++level) {
      std::vector<Side> sides;
      for (int row = problem_.first_row(level); row < problem_.end_row(level); ++row) {
        for (Side& side : sides_of_row(problem_, row)) sides.push_back(std::move(side));
      }
      optimise(sides);
      keep(level);
    }
    SlowSolution result;
    for (int level = 0; level < problem_.levels(); ++level) {
      result.slack_norms.push_back(static_cast<double>(slack_norm(level)));
    }
    if (minimum_norm) {
      std::vector<Side> sides;
      for (int i = 0; i < n_; ++i) {
        for (const Real sign : {1.0L, -1.0L})
          sides.push_back({sign * Vector::Unit(n_, i), 0, 1, 1});
      }
      optimise(sides);
    }
    for (const Real x : x_) result.x.push_back(static_cast<double>(x));
    result.doubt = doubt_;
    return result;
  }

 private:
  Real excess(const Side& side) const { return side.c.dot(x_) - side.bound; }
  Real scale(const Side& side) const { return std::abs(side.bound) + side.norm * reach_; }
  Real free_share(const Vector& c) const { return (free_.transpose() * c).norm() / c.norm(); }

  Real slack_norm(int level) const {
    Real sum = 0.0L;
    for (int row = problem_.first_row(level); row < problem_.end_row(level); ++row) {
      for (const Side& side : sides_of_row(problem_, row)) {
        const Real slack = side.weight * std::max(Real(0), excess(side));
        sum += slack * slack;
      }
    }
    return std::sqrt(sum);
  }

  void doubt(const std::string& reason) {
    if (doubt_.empty()) doubt_ = reason;
  }

  bool exceeds(Real share, const Threshold& threshold, const char* what) {
    if (share > threshold.none && share < threshold.some) {
      doubt(std::string(what) + " of " + std::to_string(std::log10(share)) + " decades");
    }
    return share >= std::sqrt(threshold.none * threshold.some);
  }

  // min 1/2 sum (weight * slack)^2 over the sides, within the constraints.
  void optimise(std::vector<Side> sides) {
    pushing_.clear();
    std::erase_if(sides, [&](const Side& side) {
      return side.norm == 0.0L || !exceeds(free_share(side.c), kFreePart, "a free part");
    });
    for (int step = 0; step < kMaxSteps; ++step) {
      if (!approach(sides)) return;
    }
    doubt("a proximal method without end");
  }

  // One proximal step: min 1/2 sum (weight * slack)^2 + 1/2 kProximity * (size * |step|)^2. False
  // when x does not move any more.
  bool approach(const std::vector<Side>& sides) {
    Vector slacks = Vector::Zero(sides.size());
    Real size = 0.0L;
    bool is_met = true;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Side& side = sides[i];
      size = std::max(size, side.weight * side.norm);
      slacks[i] = side.weight * excess(side);
      is_met = is_met && excess(side) <= 1e-17L * scale(side);
    }
    if (is_met) {
      pushing_.clear();
      return false;
    }

    // unknown: the free part of step * size * sqrt(kProximity), then slacks, as shares of `unit`
    const Real unit = slacks.cwiseMax(Real(0)).norm();
    const Real factor = 1.0L / (size * std::sqrt(kProximity));
    const Eigen::Index k = free_.cols();
    const Eigen::Index m = slacks.size();
    Matrix G = Matrix::Zero(m + static_cast<Eigen::Index>(constraints_.size()), k + m);
    Vector h(G.rows());
    G.topRightCorner(m, m).setIdentity();
    for (Eigen::Index i = 0; i < m; ++i) {
      G.row(i).head(k) = -factor * sides[i].weight * (sides[i].c.transpose() * free_);
      h[i] = slacks[i] / unit;
    }
    for (Eigen::Index i = m; i < G.rows(); ++i) {
      const Side& side = constraints_[i - m];
      const bool is_touched = std::abs(excess(side)) <= kViolation.none * scale(side);
      G.row(i).head(k) = -factor * size / side.norm * (side.c.transpose() * free_);
      h[i] = is_touched ? 0.0L : size / side.norm * excess(side) / unit;
    }
    Vector z, mu;
    if (!find_least_distance(G, h, z, mu)) {
      doubt("a least-distance program without solution");
      return false;
    }
    const Vector step = free_ * z.head(k) * (factor * unit);
    x_ += step;
    reach_ = std::max({reach_, x_.norm(), unit / size});

    pushing_.assign(constraints_.size(), 0.0L);
    Real gradient = 0.0L;
    for (Eigen::Index i = 0; i < m; ++i) {
      gradient += mu[i] * sides[i].weight * sides[i].norm / size;
    }
    for (Eigen::Index i = m; i < G.rows(); ++i) pushing_[i - m] = mu[i] / gradient;
    return step.norm() * size > kStandstill * unit;
  }

  // What the level has got: slacks that cannot become smaller, rows above that push against it,
  // which therefore stay where they are, and rows that must not be violated from here on.
  void keep(int level) {
    std::vector<Vector> equalities;
    std::vector<Side> constraints;
    for (std::size_t i = 0; i < constraints_.size(); ++i) {
      const bool has_positive_multiplier =
          !pushing_.empty() && exceeds(pushing_[i], kPush, "a push");
      if (has_positive_multiplier) equalities.push_back(constraints_[i].c);
    }
    for (int row = problem_.first_row(level); row < problem_.end_row(level); ++row) {
      const std::vector<Side> sides = sides_of_row(problem_, row);
      if (sides.empty() || sides[0].norm == 0.0L) continue;
      bool is_kept = problem_.bounds(row).lb == problem_.bounds(row).ub;
      for (const Side& side : sides) {
        const Real share = scale(side) > 0.0L ? excess(side) / scale(side) : 0.0L;
        is_kept = exceeds(share, kViolation, "a violation") || is_kept;
      }
      if (is_kept) {
        equalities.push_back(sides[0].c);
      } else {
        constraints_.insert(constraints_.end(), sides.begin(), sides.end());
      }
    }
    fix(equalities);
    std::erase_if(constraints_, [&](const Side& side) {
      return !exceeds(free_share(side.c), kFreePart, "a free part");
    });
  }

  // Takes the rows out of free_, those with the largest free part first.
  void fix(std::vector<Vector>& rows) {
    while (!rows.empty() && free_.cols() > 0) {
      const auto largest = std::max_element(
          rows.begin(), rows.end(),
          [&](const Vector& a, const Vector& b) { return free_share(a) < free_share(b); });
      if (!exceeds(free_share(*largest), kFreePart, "a free part")) return;
      const Matrix reduced = free_.transpose() * *largest;
      const Matrix Q = Eigen::HouseholderQR<Matrix>(reduced).householderQ();
      free_ = (free_ * Q.rightCols(free_.cols() - 1)).eval();
      rows.erase(largest);
    }
  }

  const Problem& problem_;
  const int n_;
  Vector x_;
  Real reach_ = 0.0L;              // largest |x| met or wanted: rounding errors scale with it
  Matrix free_;                    // orthonormal basis of what the levels so far leave free
  std::vector<Side> constraints_;  // not to be violated
  std::vector<Real> pushing_;      // by constraint: multiplier as a share of the level's gradient
  std::string doubt_;
};

}  // namespace

SlowSolution solve_slowly(const Problem& problem, bool minimum_norm) {
  return Cascade(problem).run(minimum_norm);
}

}  // namespace hg::hqp

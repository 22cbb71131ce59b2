#include "hg/hqp/test/certificate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hg::hqp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kAtBound = 1e-9;    // share of norm |x| + |bound| that counts as at the bound
constexpr double kDependent = 1e-9;  // share of a unit row that counts as independent
constexpr double kRounding = 1e-7;   // share of norm |x| + |bound| that may be missing in a slack

VectorXd row_of(const Problem& problem, int row) {
  VectorXd c = VectorXd::Zero(problem.variables());
  if (problem.variable(row) >= 0) {
    c[problem.variable(row)] = 1.0;
  } else {
    const auto coefficients = problem.coefficients(row);
    std::copy(coefficients.begin(), coefficients.end(), c.begin());
  }
  return c;
}

MatrixXd columns(const std::vector<VectorXd>& list, Eigen::Index rows) {
  MatrixXd A(rows, static_cast<Eigen::Index>(list.size()));
  for (Eigen::Index i = 0; i < A.cols(); ++i) A.col(i) = list[i];
  return A;
}

// Orthonormal basis of what is orthogonal to all columns (unit vectors) of A.
MatrixXd null_space(const MatrixXd& A, Eigen::Index n) {
  if (A.cols() == 0) return MatrixXd::Identity(n, n);
  Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  qr.setThreshold(kDependent);
  const MatrixXd Q = qr.householderQ() * MatrixXd::Identity(n, n);
  return Q.rightCols(n - qr.rank());
}

// min |A y - b| over y >= 0, by the algorithm of Lawson and Hanson; returns the minimum.
double non_negative_distance(const MatrixXd& A, const VectorXd& b) {
  const Eigen::Index m = A.cols();
  VectorXd y = VectorXd::Zero(m);
  std::vector<bool> is_passive(m, false);
  for (int step = 0; step < 10 * m + 10; ++step) {
    const VectorXd w = A.transpose() * (b - A * y);
    Eigen::Index enter = -1;
    double largest = 1e-14 * b.norm();
    for (Eigen::Index i = 0; i < m; ++i) {
      if (!is_passive[i] && w[i] > largest) {
        largest = w[i];
        enter = i;
      }
    }
    if (enter < 0) break;
    is_passive[enter] = true;
    while (true) {
      std::vector<Eigen::Index> passive;
      for (Eigen::Index i = 0; i < m; ++i) {
        if (is_passive[i]) passive.push_back(i);
      }
      if (passive.empty()) break;
      const MatrixXd A_passive = A(Eigen::all, passive);
      const VectorXd z = A_passive.completeOrthogonalDecomposition().solve(b);
      double fraction = 1.0;
      for (std::size_t i = 0; i < passive.size(); ++i) {
        const double z_i = z[i];
        const double y_i = y[passive[i]];
        if (z_i <= 0.0) fraction = std::min(fraction, y_i / (y_i - z_i + 1e-300));
      }
      for (std::size_t i = 0; i < passive.size(); ++i) {
        double& y_i = y[passive[i]];
        const double z_i = z[i];
        y_i += fraction * (z_i - y_i);
        if (fraction < 1.0 && (y_i <= 1e-15 * z.norm() || (z_i <= 0.0 && y_i <= 0.0))) {
          y_i = 0.0;
          is_passive[passive[i]] = false;
        }
      }
      if (fraction == 1.0) break;
    }
  }
  return (b - A * y).norm();
}

}  // namespace

std::vector<double> optimality_gaps(const Problem& problem, const std::vector<double>& x_values,
                                    int levels) {
  const Eigen::Index n = problem.variables();
  const VectorXd x = Eigen::Map<const VectorXd>(x_values.data(), n);
  std::vector<VectorXd> span;
  std::vector<VectorXd> cone;
  std::vector<double> gaps;

  const int end = levels == problem.levels() ? levels + 1 : levels;
  for (int level = 0; level < end; ++level) {
    const bool is_norm = level == problem.levels();
    VectorXd gradient = is_norm ? x : VectorXd::Zero(n);
    double size = is_norm ? x.norm() : 0.0;
    const auto span_above = span;
    const auto cone_above = cone;
    for (int row = is_norm ? problem.rows() : problem.first_row(level);
         row < (is_norm ? problem.rows() : problem.end_row(level)); ++row) {
      const VectorXd c = row_of(problem, row);
      if (c.norm() == 0.0) continue;
      const auto [lb, ub] = problem.bounds(row);
      const double value = c.dot(x);
      const double factor = problem.weight(row) * problem.weight(row);
      const double excess = std::max(0.0, value - ub) - std::max(0.0, lb - value);
      const auto scale = [&](double bound) {
        return c.norm() * x.norm() + (std::isfinite(bound) ? std::abs(bound) : 0.0);
      };
      gradient += factor * excess * c;
      const double nearest = value - excess;
      if (excess != 0.0) {
        size += factor * c.norm() * (std::abs(excess) + kRounding * scale(nearest));
      }
      if (lb == ub || std::abs(excess) > kAtBound * scale(nearest)) {
        span.push_back(c.normalized());
      } else {
        if (std::isfinite(ub) && value >= ub - kAtBound * scale(ub)) cone.push_back(c.normalized());
        if (std::isfinite(lb) && value <= lb + kAtBound * scale(lb))
          cone.push_back(-c.normalized());
      }
    }
    if (size == 0.0) {
      gaps.push_back(0.0);
      continue;
    }
    const MatrixXd N = null_space(columns(span_above, n), n);
    const MatrixXd A = N.transpose() * columns(cone_above, n);
    gaps.push_back(non_negative_distance(A, -N.transpose() * gradient) / size);
  }
  return gaps;
}

double largest_gap(const Problem& problem, const std::vector<double>& x, bool minimum_norm) {
  const std::vector<double> gaps = optimality_gaps(problem, x, problem.levels());
  return *std::max_element(gaps.begin(), minimum_norm ? gaps.end() : gaps.end() - 1);
}

namespace {

constexpr double kState = 1e-8;  // share of norm |x| + |bound| by which a state may be off

// What is wrong with what `solution` says of the row.
std::string fault_of_row(const Problem& problem, const Solution& solution, int row,
                         bool is_judged) {
  const Eigen::Map<const VectorXd> x(solution.x.data(), problem.variables());
  const VectorXd c = row_of(problem, row);
  const auto [lb, ub] = problem.bounds(row);
  const double value = c.dot(x);
  const double slack = solution.slack[row];
  if (!is_judged) return std::isfinite(slack) ? "" : "slack is not finite";

  const double nearest = std::clamp(value, lb, ub);
  const double tolerance = kState * (c.norm() * x.norm() + std::abs(nearest));
  if (!(std::abs(slack - (nearest - value)) <= tolerance)) return "slack is not bound - c x";
  const auto is_at = [&](double bound) { return std::abs(value - bound) <= tolerance; };
  switch (solution.state[row]) {
    case RowState::kInactive:
      return std::abs(value - nearest) <= tolerance ? "" : "an inactive row is violated";
    case RowState::kLower:
      return is_at(lb) ? "" : "a row is not at its lower bound";
    case RowState::kUpper:
      return is_at(ub) ? "" : "a row is not at its upper bound";
    case RowState::kEqual:
      return lb == ub && is_at(lb) ? "" : "an equality is not met";
    case RowState::kBelow:
      return slack > 0.0 ? "" : "a row is not below";
    case RowState::kAbove:
      return slack < 0.0 ? "" : "a row is not above";
  }
  return "a state that does not exist";
}

std::string fault_of_counts(const Problem& problem, const SolverOptions& options,
                            const Solution& solution) {
  const int completed = solution.completed_levels;
  const bool is_bad = solution.status == Status::kBadRow;
  if (solution.iterations > options.max_iterations) return "more iterations than allowed";
  if (completed < 0 || completed > problem.levels()) return "completed_levels out of range";
  if (solution.status == Status::kSolved && completed != problem.levels()) {
    return "solved, but not all levels";
  }
  if (is_bad && (solution.bad_row < 0 || solution.bad_level != problem.level_of(solution.bad_row) ||
                 completed != solution.bad_level)) {
    return "the bad row is not at the reported place";
  }
  if (static_cast<int>(solution.x.size()) != problem.variables() ||
      static_cast<int>(solution.state.size()) != problem.rows() ||
      static_cast<int>(solution.levels.size()) != problem.levels()) {
    return "vectors of wrong size";
  }
  return "";
}

}  // namespace

std::string fault_of(const Problem& problem, const SolverOptions& options, const Solution& solution,
                     double gap) {
  if (const std::string fault = fault_of_counts(problem, options, solution); !fault.empty()) {
    return fault;
  }
  for (const double x : solution.x) {
    if (!std::isfinite(x)) return "x is not finite";
  }
  const bool is_judged = std::isfinite(gap);
  const int completed = solution.completed_levels;
  for (int level = 0; level < completed; ++level) {
    for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
      const std::string fault = fault_of_row(problem, solution, row, is_judged);
      if (!fault.empty()) return "row " + std::to_string(row) + ": " + fault;
    }
  }
  if (!is_judged) return "";
  std::vector<double> gaps = optimality_gaps(problem, solution.x, completed);
  const bool is_norm_judged = solution.status == Status::kSolved && options.minimum_norm;
  if (completed == problem.levels() && !is_norm_judged) gaps.pop_back();
  for (std::size_t level = 0; level < gaps.size(); ++level) {
    if (gaps[level] <= gap) continue;
    return "level " + std::to_string(level) + " has a gap of " + std::to_string(gaps[level]);
  }
  return "";
}

}  // namespace hg::hqp

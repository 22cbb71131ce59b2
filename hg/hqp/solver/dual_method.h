/// A guess of the active set by a dual method: cheap changes instead of eliminations.
///
/// Equalities are eliminated (GaussElimination) as far as they leave freedom and do not contradict
/// each other. The first level s whose targets cannot all be met is a strictly convex quadratic
/// program in the remaining variables: least squares of its rows, inequalities of the levels above
/// as constraints, its own ones with a slack. D. Goldfarb, A. Idnani, A numerically stable dual
/// method for solving strictly convex quadratic programs, Mathematical Programming 27, 1983: from
/// the minimum without inequalities, the most violated row becomes active, and rows whose
/// multiplier changes sign are released; the orthogonal factors of the active rows are updated.
/// Rows above that contradict each other make the lowest level among them the new s. When level s
/// is settled, its result becomes equalities, and so do the rows with positive multipliers. Nothing
/// here is proof: rounding and thresholds decide what is active. The result is a guess.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"
#include "hg/hqp/solver/gauss_elimination.h"

namespace hg::hqp::solver {

class DualMethod {
 public:
  explicit DualMethod(const Capacity& capacity);

  /// Writes the active rows of the first `levels` levels into `guess`. `direct` holds the
  /// equalities of the first `top` levels, which have no other rows; on return it has other pivots
  /// behind these. `expected_violated`, per level: whether violated inequalities are expected
  /// there; such levels are settled one by one at once. False if given up: `guess` is not written.
  bool find_guess(const Problem& problem, const SolverOptions& options, int levels, int top,
                  std::span<const std::uint8_t> expected_violated, GaussElimination& direct,
                  std::vector<RowState>& guess) noexcept;
  /// Point of the guess, all variables.
  const Eigen::VectorXd& point() const noexcept { return x_; }
  /// Whether the row is active because its multiplier for some level is surely positive.
  bool has_positive_multiplier(int row) const noexcept { return has_positive_multiplier_[row]; }

 private:
  enum class Outcome : std::uint8_t { kOptimal, kContradiction, kGivenUp };
  static constexpr int kNoSlot = -1;

  /// An inequality of the program.
  struct Candidate {
    int row;
    bool is_soft;      ///< row of level s: has a slack
    bool is_excluded;  ///< active, or excluded
    int slot;          ///< index of its row in candidate_rows_, kNoSlot: not there yet
    double length;     ///< norm of that row, with its slack
  };
  /// An active row, in the direction in which it is violated.
  struct Active {
    int candidate;
    double sign;  ///< +1: at the upper bound, -1: at the lower
    double multiplier;
    int slot;  ///< index of its slack, kNoSlot: none
  };

  double* candidate_row(int i) noexcept {
    return candidate_rows_.data() + candidates_[i].slot * stride_;
  }
  double* q(int j) noexcept { return Q_.data() + j * q_stride_; }
  double* r(int j) noexcept { return R_.data() + j * max_active_; }

  int expected_level() const noexcept;
  bool choose_level(GaussElimination& direct) noexcept;
  void collect_candidates() noexcept;
  void reduce(int candidate, GaussElimination& direct) noexcept;
  bool set_up_metric(GaussElimination& direct) noexcept;
  bool factorise(GaussElimination& direct, bool is_regular) noexcept;
  Interval triangularise(int rows, bool is_regular) noexcept;
  void collect_targets() noexcept;
  int collect_objective(GaussElimination& direct, bool is_regular) noexcept;
  int most_violated() const noexcept;
  Outcome run(GaussElimination& direct) noexcept;
  double project(const Active& entering) noexcept;
  void append(const Active& entering, double z_squared) noexcept;
  void remove(int j) noexcept;
  int level_of_contradiction(GaussElimination& direct) noexcept;
  void find_point(GaussElimination& direct) noexcept;
  void fix_level(GaussElimination& direct) noexcept;
  void write(std::vector<RowState>& guess) const noexcept;

  // data of the solve
  const Problem* problem_ = nullptr;
  const SolverOptions* options_ = nullptr;
  int levels_ = 0;
  std::span<const std::uint8_t> expected_violated_;
  int first_ = 0;  ///< levels above are settled
  int level_ = 0;  ///< s; problem.levels(): the smallest |x|
  int last_ = 0;   ///< the largest level that s may be
  int changes_ = 0;
  int max_changes_ = 0;
  std::vector<int> rank_at_level_;
  std::vector<std::uint8_t> has_positive_multiplier_;  ///< per row
  /// Per row: +1, -1: permanently active at its upper, lower bound
  std::vector<std::int8_t> side_;

  // data of the program: free variables, its objective |M x - y0|, M being an upper triangle,
  // candidates and their rows c M^-1
  int max_active_;
  int freedom_ = 0;
  int stride_ = 0;
  std::vector<int> free_;
  std::vector<double> objective_;      ///< M, its columns freedom_ apart
  std::vector<double> objective_rhs_;  ///< y0
  bool has_objective_ = false;         ///< level s can change its objective
  double regularisation_ = 0.0;  ///< weight of the smallest |x| beside a level that leaves freedom
  double x_norm_ = 0.0;
  std::vector<Candidate> candidates_;
  std::vector<double> candidate_rows_;  ///< rows that were active or candidates to enter
  int reduced_rows_ = 0;
  Eigen::VectorXd x_;
  Eigen::VectorXd reduced_;

  // data of the active rows N = Q R, N with a column per row
  int q_stride_ = 0;
  int slots_ = 0;
  int used_slots_ = 0;
  Active entering_ = {};
  int contradiction_ = 0;  ///< lowest level in the contradiction
  std::vector<Active> active_;
  std::vector<std::uint8_t> is_slot_used_;
  std::vector<double> Q_;
  std::vector<double> R_;
  Eigen::VectorXd u_;  ///< M x - y0, and slacks
  Eigen::VectorXd a_;
  Eigen::VectorXd z_;
  Eigen::VectorXd d_;
  Eigen::VectorXd ratio_;
  std::vector<TargetRow> targets_;
};

}  // namespace hg::hqp::solver

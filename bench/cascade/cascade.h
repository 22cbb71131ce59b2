/// The solver of the paper: one QP per level, for comparison in benchmarks only.
///
/// Source: [HG] (2)-(6). Level p: with x = x* + Z z, Z spanning the null space of the equality rows
/// above (3)-(4), minimise |A (x* + Z z) - b|^2 + |v|^2 subject to the rows of this level with
/// slack v and all rows above with their optimal slack. As [HG] says, the diagonal of the Hessian
/// and the bounds get small epsilons. Back end: eiquadprog-fast (dual active set, Goldfarb,
/// Idnani), where [HG] has QuadProg++. Rows with lb = ub count as equalities. Differs from [HG]: a
/// level whose QP fails leaves x unchanged and the next levels continue. Uses only inline functions
/// of hg/hqp/problem.h, so that it can be loaded by a running program.
#pragma once

#include <Eigen/Dense>
#include <eiquadprog/eiquadprog-fast.hpp>
#include <vector>

#include "hg/hqp/problem.h"

namespace hg::bench {

/// Options of the cascade, chosen for the fewest errors on the recorded problems
/// (docs/reports/benchmarks.md).
struct CascadeOptions {
  double hessian_epsilon = 1e-11;
  double bound_epsilon = 1e-9;
  double rank_threshold = 1e-9;
};

class Cascade {
 public:
  explicit Cascade(const CascadeOptions& options = {}) : options_(options) {}

  /// Writes problem.variables() numbers to `x`. False when the QP of a level was not solved.
  bool solve(const hqp::Problem& problem, double* x);

 private:
  /// An inequality row of a level above, with its optimal slack.
  struct Kept {
    int row;
    double slack;
  };

  void collect(const hqp::Problem& problem, int level);
  void fill_objective();
  void fill_constraints(const hqp::Problem& problem);
  bool solve_level();
  void keep_inequalities(const hqp::Problem& problem);
  void shrink_null_space();

  CascadeOptions options_;
  eiquadprog::solvers::EiquadprogFast qp_;
  Eigen::VectorXd x_, zeta_;
  Eigen::MatrixXd Z_, A_, AZ_;
  Eigen::VectorXd b_;
  std::vector<int> own_;    ///< inequality rows of the level
  std::vector<Kept> kept_;  ///< inequality rows of the levels above
  Eigen::MatrixXd H_, CI_, CE_;
  Eigen::VectorXd g_, ci0_, ce0_, c_;
};

}  // namespace hg::bench

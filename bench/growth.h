/// Growth of the solver's time with variables and levels, on random well-posed problems.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/times.h"
#include "hg/core/random.h"
#include "hg/hqp/problem.h"

namespace hg::bench {

/// A random problem that changes a little from step to step, as in a control loop.
///
/// n variables, P levels, 2.5 n rows, all of length 1. Level after level in turn: n/2 equalities;
/// n/2 limits of single variables and n/2 of random directions, 0.1 to 1 to either side of a point
/// that fulfils all of these rows. The last level also wishes every variable, n rows, by normal
/// random numbers of standard deviation 1 away from that point, so that many limits act. Directions
/// are uniform. A step turns every direction by about 1e-3 rad and moves point and wishes by 1e-3.
class GrowingProblem {
 public:
  /// Same arguments, same problem. Needs n even, n >= 2, levels >= 1.
  GrowingProblem(int n, int levels, std::uint32_t seed);

  void step();
  const hqp::Problem& problem() const { return problem_; }
  /// Point that fulfils every row except the wishes.
  const Eigen::VectorXd& point() const { return point_; }
  /// Id of the first wish; the others follow.
  int first_wish() const { return problem_.rows() - problem_.variables(); }

 private:
  struct Row {
    int variable;               ///< index of the variable; -1 = dense row
    Eigen::VectorXd direction;  ///< direction of a dense row
    double below, above;        ///< width of the interval on either side of the point
  };

  Eigen::VectorXd random_direction();
  void add_rows();
  void set_bounds();

  Random32 random_;
  Eigen::VectorXd point_, wish_;
  std::vector<Row> rows_;  ///< rows by id, without the wishes
  hqp::Problem problem_;
};

/// Times of all problems and steps of one size.
struct GrowthRow {
  int variables = 0, levels = 0, rows = 0;
  Times cold, warm;
  double cold_iterations = 0.0, warm_iterations = 0.0;  ///< mean number of iterations
  std::size_t failures = 0;
};

/// Times five problems of the size, four steps each after one that is not timed.
GrowthRow measure_growth(int variables, int levels, int passes);

}  // namespace hg::bench

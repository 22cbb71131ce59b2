/// Least squares of friction with Huber's weights, and its deviations; see friction.h.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hg/identify/friction_rows.h"

namespace hg::identify::friction {

/// Robust standard deviation of the non-zero residuals, Nm.
double deviation_of(const Eigen::VectorXd& residuals);

/// Fits models to rows; the rows must outlive it.
class Fit {
 public:
  explicit Fit(const Rows& rows)
      : rows_(rows), linear_(rows.linear()), counts_(Eigen::VectorXd::Ones(rows.size())) {}

  /// Sets the factor, 0 or 1, by which each row counts.
  void count(const Eigen::VectorXd& rows) { counts_ = rows; }

  /// Residuals of all rows, Nm; 0 where a row does not count.
  Eigen::VectorXd residuals(const Model& model) const;
  double rms(const Model& model) const;

  /// Solves for the linear parameters and F with the others given; mu / F stays. Returns the loss.
  double solve_linear(Model& model, const Free& free, double& deviation) const;

  /// Improves `model` by Levenberg and Marquardt. Returns the loss.
  double improve(Model& model, const Free& free, double deviation) const;

  /// Standard deviations by leaving out one block after the other, one step each; 0 where not free.
  Parameters deviations(const Model& model, const Free& free, double deviation) const;

 private:
  struct Normal {
    Eigen::MatrixXd J, H;
    Eigen::VectorXd r, w, g;
    std::vector<int> of;  // parameter per column
  };

  // rows of one block are no independent evidence against a prior
  double precision(double prior, double deviation) const;
  // By how much the others, which might do the same, enlarge the variance of each parameter.
  static Eigen::VectorXd inflation_of(const Eigen::MatrixXd& H);
  double total(const Model& model, double deviation) const;
  static void confine(Model& model);

  Normal normal_of(const Model& model, const Free& free, double deviation) const;

  const Rows& rows_;
  Eigen::MatrixXd linear_;
  Eigen::VectorXd counts_;
};

}  // namespace hg::identify::friction

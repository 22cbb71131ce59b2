/// Linear least squares whose deviations are a jackknife over blocks of rows: errors that last
/// longer than a row count in full.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hg::identify {

inline constexpr double kBlock_s = 1.0;    ///< length of a block, s
inline constexpr int kFewestOfBlocks = 8;  ///< fewest blocks that show a deviation

/// What the rows determine.
struct Regressed {
  Eigen::VectorXd x;           ///< parameters
  Eigen::MatrixXd covariance;  ///< by leaving out one block after the other
  Eigen::MatrixXd inverse;     ///< of A^T A with the prior
  /// Variance of a row, times the number of rows that are no evidence of their own; inverse times
  /// inflation is a covariance that knows of the prior
  double inflation = 1.0;
  double residual = 0.0;  ///< rms of the weighted residual
};

class BlockRegression {
 public:
  explicit BlockRegression(Eigen::Index columns) : columns_(columns) {}

  /// Begins a block; call before its first row.
  void begin_block();
  /// Adds the rows y = A x of one moment, each already divided by its deviation.
  void add(const Eigen::MatrixXd& A, const Eigen::VectorXd& y);

  int blocks() const noexcept { return static_cast<int>(blocks_.size()); }
  /// Solves with a prior around 0: `prior` has the standard deviation of each parameter, infinity =
  /// none. Needs a block.
  Regressed solve(const Eigen::VectorXd& prior) const;

 private:
  Regressed solve(const std::vector<Eigen::Index>& used, const Eigen::VectorXd& precision,
                  const std::vector<Eigen::Index>& judged) const;
  double inflation_of(const std::vector<Eigen::Index>& used, const Eigen::VectorXd& x,
                      const std::vector<Eigen::Index>& judged) const;

  struct Block {
    Eigen::MatrixXd H;
    Eigen::VectorXd g;
    double yy = 0.0;
    double rows = 0.0;
  };
  Block total() const;

  Eigen::Index columns_;
  std::vector<Block> blocks_;
};

}  // namespace hg::identify

/// Minimises a function of a few variables that has edges and cannot be differentiated.
///
/// CMA-ES with its usual constants: N. Hansen, The CMA Evolution Strategy: A Tutorial,
/// arXiv 1604.00772, without restarts and negative weights.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace hg::tuning {

struct EvolutionConfig {
  double step = 0.1;     ///< first standard deviation of every variable
  int generations = 60;  ///< at most
  int children = 12;     ///< per generation, >= 4
  std::uint32_t seed = 1;
};

/// Values of the function for all of `x`, which may be found side by side.
using Costs = std::function<std::vector<double>(const std::vector<Eigen::VectorXd>& x)>;
/// After every generation: how many there were, and the lowest cost so far.
using Watched = std::function<void(int generation, double best)>;

/// The best of all x that were tried, `start` among them. The same arguments give the same result.
Eigen::VectorXd minimise(const Costs& costs, const Eigen::VectorXd& start,
                         const EvolutionConfig& config, const Watched& watched);

}  // namespace hg::tuning
